//! Shell completions and manual pages, generated from the options.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use command_line::stdout;

use super::Cli;

#[derive(Debug, Args)]
pub(crate) struct CompletionsConfig {
    /// Shell to generate completions for
    shell: Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManConfig {
    /// Folder for the pages: backcast.1, and one for each command
    folder: PathBuf,
}

pub(crate) fn completions(config: &CompletionsConfig) -> anyhow::Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(config.shell, &mut Cli::command(), "backcast", &mut script);
    stdout::print(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn man(config: &ManConfig) -> anyhow::Result<ExitCode> {
    clap_mangen::generate_to(Cli::command(), &config.folder)
        .with_context(|| format!("cannot write manual pages to {}", config.folder.display()))?;
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_a_page() {
        let folder = tempfile::tempdir().unwrap();
        let config = ManConfig {
            folder: folder.path().to_owned(),
        };
        man(&config).unwrap();
        let mut command = Cli::command();
        command.build();
        let shown = command.get_subcommands().filter(|c| !c.is_hide_set());
        for name in shown
            .map(clap::Command::get_name)
            .filter(|name| *name != "help")
        {
            let page = folder.path().join(format!("backcast-{name}.1"));
            assert!(page.is_file(), "{}", page.display());
        }
        assert!(folder.path().join("backcast.1").is_file());
    }
}
