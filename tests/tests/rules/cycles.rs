//! Files of a crate depend on each other in one direction.
//!
//! A file in a folder may use its folder's `mod.rs`, and the other way round: `mod.rs` serves the
//! files in it. Between all others there is no cycle, so that each file can be read with only those
//! on which it builds. Items that an error names, such as an exceeded limit, do not count:
//! `error.rs` does nothing with them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use syn::visit::Visit;
use syn::{Attribute, Item};

use crate::workspace::{imports, metadata, names};

/// Path of a module from the root of its crate.
type Name = Vec<String>;

/// Items and uses of a file, including those inside functions; test modules are left out.
#[derive(Default)]
struct Module {
    /// Child modules, in files of their own and in this one.
    children: BTreeSet<String>,
    /// Imported items, by their local names.
    imports: BTreeMap<String, Name>,
    /// Modules that are imported with `*`.
    globs: Vec<Name>,
    /// Names of the items defined here.
    items: BTreeSet<String>,
    paths: BTreeSet<Name>,
}

#[test]
fn no_two_files_of_a_crate_depend_on_each_other() {
    let mut seen = 0;
    let mut cycles = Vec::new();
    for package in metadata()["packages"].as_array().unwrap() {
        for target in package["targets"].as_array().unwrap() {
            let root = Path::new(target["src_path"].as_str().unwrap());
            let is_of_src = root.parent().unwrap().ends_with("src");
            if !is_of_src {
                continue;
            }
            let modules = modules_of(root);
            seen += modules.len();
            let crate_name = package["name"].as_str().unwrap();
            let found = cycles_between(&modules).into_iter();
            cycles.extend(found.map(|way| format!("{crate_name}: {way}")));
        }
    }
    assert!(seen > 500, "only {seen} files were read");
    assert!(cycles.is_empty(), "{}", cycles.join("\n"));
}

/// Returns the modules of a crate that have files of their own, except those of tests.
fn modules_of(root: &Path) -> BTreeMap<Name, Module> {
    let mut modules = BTreeMap::new();
    let folder = root.parent().unwrap();
    read(root, folder, Vec::new(), &mut modules);
    modules
}

fn read(file: &Path, folder: &Path, name: Name, modules: &mut BTreeMap<Name, Module>) {
    let source = syn::parse_file(&std::fs::read_to_string(file).unwrap()).unwrap();
    let mut module = Module::default();
    // Modules in a group with its own path are files of this folder.
    let grouped = source.items.iter().filter_map(|item| match item {
        Item::Mod(group) if group.attrs.iter().any(|a| a.path().is_ident("path")) => {
            group.content.as_ref()
        }
        _ => None,
    });
    for item in grouped.flat_map(|(_, items)| items).chain(&source.items) {
        if let Item::Mod(child) = item
            && child.content.is_none()
            && !is_for_tests(&child.attrs)
        {
            let child = child.ident.to_string();
            let below = folder.join(&child);
            let alone = below.with_extension("rs");
            let file = match alone.exists() {
                true => alone,
                false => below.join("mod.rs"),
            };
            read(&file, &below, joined(&name, [&child]), modules);
            module.children.insert(child);
        }
    }
    module.visit_file(&source);
    modules.insert(name, module);
}

fn is_for_tests(attributes: &[Attribute]) -> bool {
    let is_cfg = |attribute: &&Attribute| attribute.path().is_ident("cfg");
    attributes.iter().filter(is_cfg).any(|attribute| {
        let tokens = &attribute.meta.require_list().unwrap().tokens;
        tokens.to_string().contains("test")
    })
}

fn joined<S: ToString>(name: &[String], rest: impl IntoIterator<Item = S>) -> Name {
    let rest = rest.into_iter().map(|part| part.to_string());
    name.iter().cloned().chain(rest).collect()
}

impl<'ast> Visit<'ast> for Module {
    fn visit_item(&mut self, item: &'ast Item) {
        let defined = match item {
            Item::Mod(inner) if is_for_tests(&inner.attrs) => return,
            Item::Use(item) => {
                for (name, path) in imports(&[], &item.tree) {
                    match name.as_str() {
                        "*" => self.globs.push(path),
                        _ => _ = self.imports.insert(name, path),
                    }
                }
                return;
            }
            Item::Const(item) => Some(&item.ident),
            Item::Enum(item) => Some(&item.ident),
            Item::Fn(item) => Some(&item.sig.ident),
            Item::Static(item) => Some(&item.ident),
            Item::Struct(item) => Some(&item.ident),
            Item::Trait(item) => Some(&item.ident),
            Item::Type(item) => Some(&item.ident),
            Item::Union(item) => Some(&item.ident),
            _ => None,
        };
        self.items.extend(defined.map(ToString::to_string));
        syn::visit::visit_item(self, item);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.paths.insert(names(path));
        syn::visit::visit_path(self, path);
    }
}

/// Returns the module of this crate that defines the item of a path, if there is one.
///
/// `asked` are the modules whose globs are being followed: two may import each other.
fn home(
    modules: &BTreeMap<Name, Module>,
    from: &[String],
    path: &[String],
    asked: &mut BTreeSet<Name>,
) -> Option<Name> {
    let mut at = from.to_vec();
    let mut path = path;
    while let [first, rest @ ..] = path {
        let module = &modules[&at];
        match first.as_str() {
            "crate" => at.clear(),
            "self" => {}
            "super" => _ = at.pop(),
            first if module.children.contains(first) => at.push(first.to_owned()),
            first if module.items.contains(first) => return Some(at),
            first => {
                // An item imported from a crate may have the name of the crate.
                let imported = module.imports.get(first);
                if let Some(import) = imported.filter(|import| import[0] != first) {
                    return home(modules, &at, &joined(import, rest), asked);
                }
                if !asked.insert(at.clone()) {
                    return None;
                }
                let found = module.globs.iter().find_map(|glob| {
                    let place = home(modules, &at, glob, asked)?;
                    home(modules, &place, path, asked)
                });
                asked.remove(&at);
                return found;
            }
        }
        path = rest;
    }
    Some(at)
}

/// Returns the dependencies between files that depend on each other, directly or through others.
fn cycles_between(modules: &BTreeMap<Name, Module>) -> Vec<String> {
    let uses: BTreeMap<&Name, BTreeMap<Name, BTreeSet<String>>> = modules
        .iter()
        .map(|(name, module)| {
            if name.last().is_some_and(|file| file == "error") {
                return (name, BTreeMap::new());
            }
            let paths = module.imports.values().chain(&module.globs);
            let mut uses: BTreeMap<Name, BTreeSet<String>> = BTreeMap::new();
            for path in paths.chain(&module.paths) {
                let home = home(modules, name, path, &mut BTreeSet::new());
                let is_beside = |home: &Name| !home.starts_with(name) && !name.starts_with(home);
                if let Some(home) = home.filter(is_beside) {
                    let what = path.last().unwrap().clone();
                    uses.entry(home).or_default().insert(what);
                }
            }
            (name, uses)
        })
        .collect();
    let reaches = |from: &Name, to: &Name| {
        let (mut reached, mut next) = (BTreeSet::new(), vec![from]);
        while let Some(name) = next.pop() {
            if name == to {
                return true;
            }
            if reached.insert(name) {
                next.extend(uses[name].keys());
            }
        }
        false
    };
    let mut ways = Vec::new();
    for (from, others) in &uses {
        for (to, what) in others.iter().filter(|(to, _)| reaches(to, from)) {
            let what = Vec::from_iter(what.iter().map(String::as_str)).join(", ");
            ways.push(format!("{} -> {}: {what}", from.join("::"), to.join("::")));
        }
    }
    ways
}

#[test]
fn ways_back_are_found_through_names_that_are_handed_on() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write(
        "lib.rs",
        "mod a; mod b; mod c; mod d; mod error; pub use d::*; #[cfg(test)] mod tests;",
    );
    write("a/mod.rs", "mod inner; pub use inner::Inner;");
    // A child may use its parent, and the modules next to that.
    write("a/inner.rs", "use super::*; pub struct Inner(crate::c::C);");
    write("b.rs", "use crate::{a::Inner as I, D}; pub struct B(I);");
    write("c.rs", "pub struct C; fn f() { crate::b::B::new(); }");
    write(
        "d.rs",
        "pub struct D; #[cfg(test)] mod tests { use crate::b::B; }",
    );
    write("error.rs", "use crate::b::B; pub struct Error;");
    let ways = cycles_between(&modules_of(&folder.path().join("lib.rs")));
    let expected = ["a::inner -> c: C", "b -> a::inner: I, Inner", "c -> b: new"];
    assert_eq!(ways, expected);
}
