//! The rooms of the house: what each uses, and that no files import each other in a circle.

use super::manual::{root, text};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The code of a file without its tests and comments: an item below `#[cfg(test)]` ends with its braces or its semicolon.
fn without_tests(text: &str) -> String {
    let mut rest = text;
    let mut code = String::new();
    while let Some((before, item)) = rest.split_once("#[cfg(test)]") {
        code.push_str(before);
        let body = item.find(['{', ';']).expect("an item");
        let mut depth = 0;
        let end = item[body..].char_indices().find(|&(_, c)| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth == 0
        });
        rest = &item[body + end.map_or(item.len() - body, |(at, _)| at + 1)..];
    }
    code.push_str(rest);
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .fold(String::new(), |all, line| all + line + "\n")
}

/// The files of a room with its own code: tests, examples and fixtures do not count.
fn files_of(room: &Path) -> Vec<PathBuf> {
    if room.is_file() {
        return vec![room.to_owned()];
    }
    let is_code = |path: &Path| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        !name.starts_with("tests")
            && name != "examples.rs"
            && (path.is_dir() || path.extension().is_some_and(|ending| ending == "rs"))
    };
    let entries = fs::read_dir(room).expect("a room").map(|entry| entry.expect("an entry").path());
    entries.filter(|path| is_code(path)).flat_map(|path| files_of(&path)).collect()
}

/// The rooms that a room refers to as `crate::ROOM` or `crate::{ROOM, …}`.
fn rooms_used(room: &Path) -> BTreeSet<String> {
    let is_in_name = |c: char| c.is_ascii_lowercase() || c == '_';
    let mut used = BTreeSet::new();
    for file in files_of(room) {
        let code = without_tests(&fs::read_to_string(&file).expect("a source file"));
        for after in code.split("crate::").skip(1) {
            let list = after.strip_prefix('{').and_then(|list| list.split_once('}'));
            let names =
                list.map_or_else(|| vec![after], |(list, _)| list.split(',').map(str::trim).collect());
            used.extend(
                names
                    .into_iter()
                    .map(|name| name.split(|c| !is_in_name(c)).next().unwrap_or_default().to_owned()),
            );
        }
    }
    used
}

/// The tables of rooms list what each room uses, and a room uses only those above it, so there is no cycle.
#[test]
fn the_tables_of_rooms_say_what_each_room_uses() {
    const EVERYWHERE: [&str; 3] = ["elementary", "exact", "progress"];
    let page = text("ARCHITECTURE.md");
    for base in ["engine/src/", "src/"] {
        let rows: Vec<(&str, &str)> = page
            .lines()
            .filter_map(|line| line.strip_prefix("| `")?.strip_prefix(base)?.split_once('`'))
            .map(|(room, rest)| {
                (room, rest.trim_end_matches('|').rsplit('|').next().unwrap_or_default().trim())
            })
            .collect();
        assert!(rows.len() > 8, "{base}: {} rows", rows.len());
        let names: Vec<&str> = rows.iter().map(|(room, _)| room.trim_end_matches(".rs")).collect();
        for (index, &(room, uses)) in rows.iter().enumerate() {
            let mut used = rooms_used(&root().join(base).join(room));
            used.retain(|name| {
                name != names[index] && names.contains(&name.as_str()) && !EVERYWHERE.contains(&name.as_str())
            });
            let said: BTreeSet<String> =
                uses.split(", ").filter(|name| !name.is_empty()).map(str::to_owned).collect();
            assert_eq!(used, said, "{base}{room}: what it uses (left) and what ARCHITECTURE.md says (right)");
            for name in &used {
                assert!(
                    names[..index].contains(&name.as_str()),
                    "{base}{room} uses {name}, which stands below it"
                );
            }
        }
    }
}

/// A module by its path from the root of its package.
type Module = Vec<String>;

/// What the files of a package import: for themselves, and to hand on.
struct Imports {
    own: BTreeMap<Module, Vec<Vec<String>>>,
    handed_on: BTreeMap<Module, Vec<Vec<String>>>,
}

impl Imports {
    fn of(base: &Path) -> Self {
        let mut all = Self { own: BTreeMap::new(), handed_on: BTreeMap::new() };
        for file in files_of(base) {
            let inside = file.strip_prefix(base).expect("a file of the package").with_extension("");
            let mut module: Module =
                inside.iter().map(|part| part.to_str().expect("a name").to_owned()).collect();
            if module.last().is_some_and(|name| matches!(&**name, "mod" | "lib" | "main")) {
                module.pop();
            }
            let code = without_tests(&fs::read_to_string(&file).expect("a source file"));
            let (mut own, mut handed_on) = (Vec::new(), Vec::new());
            for (before, tree) in code.split("use ").zip(code.split("use ").skip(1)) {
                let line = before.rsplit('\n').next().unwrap_or_default().trim();
                let is_handed_on = line.starts_with("pub");
                if line.is_empty() || is_handed_on {
                    let tree: String =
                        tree.split(';').next().unwrap_or_default().split_whitespace().collect();
                    let paths = expanded(&tree).into_iter();
                    let paths = paths.map(|path| path.split("::").map(str::to_owned).collect());
                    if is_handed_on { handed_on.extend(paths) } else { own.extend(paths) }
                }
            }
            all.own.entry(module.clone()).or_default().extend(own);
            all.handed_on.entry(module).or_default().extend(handed_on);
        }
        all
    }

    /// The module in which a path that `from` imports is defined; `None` outside the package.
    fn module(&self, from: &Module, path: &[String], depth: usize) -> Option<Module> {
        let is_known = |module: &Module| self.own.contains_key(module);
        let below = |module: &Module, name: &String| [&module[..], std::slice::from_ref(name)].concat();
        let mut rest = path;
        let mut at = match rest.first()?.as_str() {
            "crate" => Vec::new(),
            "super" | "self" => from.clone(),
            _ if is_known(&below(from, &rest[0])) => from.clone(),
            _ => return None,
        };
        while let Some(name) = rest.first() {
            match name.as_str() {
                "crate" | "self" => {}
                "super" => at.truncate(at.len().saturating_sub(1)),
                _ if is_known(&below(&at, name)) => at = below(&at, name),
                _ => break,
            }
            rest = &rest[1..];
        }
        // The file of a folder hands on what its files define.
        let handed = rest.first().filter(|_| depth < 8).and_then(|name| {
            let path = self.handed_on.get(&at)?.iter().find(|path| path.last() == Some(name))?;
            self.module(&at, path, depth + 1)
        });
        Some(handed.unwrap_or(at)).filter(is_known)
    }

    /// The modules that each module imports from.
    fn graph(&self) -> BTreeMap<&Module, BTreeSet<Module>> {
        let used = |(module, paths)| {
            let paths: &Vec<Vec<String>> = paths;
            let all = paths.iter().filter_map(|path| self.module(module, path, 0));
            (module, all.filter(|used| used != module).collect())
        };
        self.own.iter().map(used).collect()
    }
}

/// The paths of a tree of imports without spaces, each without its other name.
fn expanded(tree: &str) -> Vec<String> {
    let Some((before, list)) = tree.split_once('{') else { return vec![tree.to_owned()] };
    let list = &list[..list.rfind('}').unwrap_or(list.len())];
    let mut depth = 0;
    let parts = list.split(|c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    let parts = parts.filter(|part| !part.is_empty());
    parts.flat_map(|part| expanded(part).into_iter().map(|rest| format!("{before}{rest}"))).collect()
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    assert_eq!(expanded("a::{b,c::{self,D},E}"), ["a::b", "a::c::self", "a::c::D", "a::E"]);
    for base in ["engine/src", "src"] {
        let imports = Imports::of(&root().join(base));
        let mut left = imports.graph();
        let arrows: usize = left.values().map(BTreeSet::len).sum();
        assert!(left.len() > 200 && arrows > 1000, "{base}: {} files, {arrows} imports", left.len());
        // Files that import from no other that is left stand at the ground; what remains is a circle, or above one.
        loop {
            let ground: Vec<Module> =
                left.iter().filter(|(_, used)| used.is_empty()).map(|(at, _)| (*at).clone()).collect();
            if ground.is_empty() {
                break;
            }
            left.retain(|module, _| !ground.contains(module));
            for used in left.values_mut() {
                used.retain(|at| !ground.contains(at));
            }
        }
        let remain: Vec<String> = left
            .iter()
            .map(|(module, used)| {
                let used: Vec<String> = used.iter().map(|at| at.join("/")).collect();
                format!("{} uses {}", module.join("/"), used.join(", "))
            })
            .collect();
        assert!(remain.is_empty(), "{base}: in a circle, or above one: {remain:#?}");
    }
}

/// Each test binary is linked with the whole program, so there are few, and every file is in one of them.
#[test]
fn the_tests_are_few_binaries_and_each_file_is_in_one() {
    let mut binaries = 0;
    for folder in ["tests", "engine/tests"] {
        for entry in fs::read_dir(root().join(folder)).unwrap().map(Result::unwrap) {
            let path = entry.path();
            let is_file = path.extension().is_some_and(|ending| ending == "rs");
            binaries += usize::from(is_file || path.join("main.rs").exists());
            let Ok(main) = fs::read_to_string(path.join("main.rs")) else { continue };
            for file in files_of(&path).iter().filter(|file| file.parent() == Some(&path)) {
                let name = file.file_stem().unwrap().to_str().unwrap();
                let is_in_it = name == "main" || main.contains(&format!("mod {name};"));
                assert!(is_in_it, "{} is no part of its main.rs: it would never run", file.display());
            }
        }
    }
    assert!(binaries <= 6, "{binaries} test binaries: put a new file beside those that it is like");
}
