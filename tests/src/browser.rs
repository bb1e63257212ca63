//! A headless Chromium that looks at a page, controlled by WebDriver.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;

use fantoccini::wd::TimeoutConfiguration;
use fantoccini::{Client, ClientBuilder};
use hyper_util::client::legacy::connect::HttpConnector;
use serde_json::{Value, json};

use crate::Killed;
use crate::needs::Need;

/// A browser with a window; it ends when this is dropped.
pub struct Browser {
    client: Client,
    runtime: tokio::runtime::Runtime,
    _driver: Killed,
}

impl Browser {
    /// Opens a window of this size in pixels; below a width of 500 it is that of a telephone.
    /// Returns `None` if Chromium or its driver is not installed, which is reported for this test.
    pub fn open(test: &str, width: u32, height: u32) -> Option<Self> {
        let browser = Browser::installed(width, height);
        if browser.is_none() {
            Need::Browser.is_missing(test, "there is no chromium or no chromedriver");
        }
        browser
    }

    fn installed(width: u32, height: u32) -> Option<Self> {
        let chromium = Command::new("chromium").arg("--version").output();
        if !chromium.is_ok_and(|outcome| outcome.status.success()) {
            return None;
        }
        let log = tempfile::NamedTempFile::new().unwrap();
        let mut driver = Command::new("chromedriver")
            .args(["--port=0", "--verbose"])
            .stdout(Stdio::piped())
            .stderr(log.reopen().unwrap())
            .spawn()
            .ok()?;
        let lines = BufReader::new(driver.stdout.take().unwrap()).lines();
        let mut ports = lines.map_while(|line| {
            let line = line.unwrap();
            let port = line.split("successfully on port ").nth(1);
            Some(port.map(|port| port.trim_end_matches('.').to_owned()))
        });
        let port = ports.find_map(|port| port).unwrap();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .unwrap();
        // As root, Chromium runs only without its sandbox; the page is ours.
        let mut options = json!({ "args": [
            "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
            format!("--window-size={width},{height}"),
        ] });
        if width < 500 {
            // No window can be so narrow, but a telephone's page can.
            options["mobileEmulation"] = json!({ "deviceMetrics":
                { "width": width, "height": height, "pixelRatio": 2.0, "touch": true } });
        }
        let capabilities = json!({ "goog:chromeOptions": options });
        let Value::Object(capabilities) = capabilities else {
            unreachable!("it was written as an object")
        };
        let client = runtime.block_on(async {
            ClientBuilder::new(HttpConnector::new())
                .capabilities(capabilities)
                .connect(&format!("http://127.0.0.1:{port}"))
                .await
                .unwrap_or_else(|error| {
                    let log = std::fs::read_to_string(log.path()).unwrap_or_default();
                    panic!("no browser: {error}\n{log}")
                })
        });
        let browser = Browser {
            client,
            runtime,
            _driver: Killed(driver),
        };
        // Tests have no time limit of their own.
        let day = Some(Duration::from_secs(86_400));
        let patience = TimeoutConfiguration::new(day, day, None);
        let set = browser.client.update_timeouts(patience);
        browser.runtime.block_on(set).unwrap();
        Some(browser)
    }

    pub fn visit(&self, url: &str) {
        self.runtime.block_on(self.client.goto(url)).unwrap();
    }

    pub fn run(&self, script: &str) -> Value {
        let ran = self.client.execute(script, Vec::new());
        self.runtime.block_on(ran).unwrap()
    }

    /// Runs a script and returns the value that it passes to `done`, sooner or later.
    pub fn finish(&self, script: &str) -> Value {
        let script = format!("const done = arguments[0]; {script}");
        let ran = self.client.execute_async(&script, Vec::new());
        self.runtime.block_on(ran).unwrap()
    }

    pub fn wait_until(&self, expression: &str) {
        let script =
            format!("const look = () => ({expression}) ? done() : setTimeout(look, 20); look();");
        let _ = self.finish(&script);
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.runtime.block_on(self.client.clone().close());
    }
}
