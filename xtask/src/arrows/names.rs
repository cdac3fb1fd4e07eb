//! What a path in a module leads to.

use std::collections::BTreeSet;

use super::tree::{ItemId, Meaning, Module, ModuleId, Sort, Tree};

/// Where a path ends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Found {
    Module(ModuleId),
    Item(ItemId),
}

/// The imports already followed, so that imports in a circle end: their module, the
/// name looked for, and the place among its meanings or globs.
type Asked = BTreeSet<(ModuleId, String, usize)>;

impl Tree {
    /// Where `path`, written in `module`, leads: to each thing that it may mean, with
    /// the names left over (an associated item, an item of another crate's type).
    pub(super) fn resolve<'p>(
        &self,
        module: ModuleId,
        path: &'p [String],
    ) -> Vec<(Found, &'p [String])> {
        self.resolve_from(module, path, &mut Asked::new())
    }

    fn resolve_from<'p>(
        &self,
        module: ModuleId,
        path: &'p [String],
        asked: &mut Asked,
    ) -> Vec<(Found, &'p [String])> {
        let Some((first, rest)) = path.split_first() else {
            return vec![(Found::Module(module), path)];
        };
        let parent = self.modules[module].parent.unwrap_or(0);
        match first.as_str() {
            "crate" => self.follow(Found::Module(0), rest, asked),
            "self" => self.follow(Found::Module(module), rest, asked),
            "super" if rest.first().is_some_and(|next| next == "super") => {
                self.resolve_from(parent, rest, asked)
            }
            "super" => self.follow(Found::Module(parent), rest, asked),
            _ => self.follow(Found::Module(module), path, asked),
        }
    }

    fn follow<'p>(
        &self,
        from: Found,
        rest: &'p [String],
        asked: &mut Asked,
    ) -> Vec<(Found, &'p [String])> {
        match (from, rest.split_first()) {
            (Found::Module(module), Some((name, rest))) => {
                let meant = self.look_up(module, name, asked);
                let further = meant.into_iter();
                further
                    .flat_map(|to| self.follow(to, rest, asked))
                    .collect()
            }
            // A function or macro has nothing within it that a path could name.
            (Found::Item(item), Some(_)) if self.items[item].sort != Sort::Type => Vec::new(),
            _ => vec![(from, rest)],
        }
    }

    /// What `name` means in `module`, re-exports looked through.
    fn look_up(&self, module: ModuleId, name: &str, asked: &mut Asked) -> Vec<Found> {
        let Module { names, globs, .. } = &self.modules[module];
        let meanings = names.get(name).map_or(&[][..], Vec::as_slice);
        let mut found = Vec::new();
        for (place, meaning) in meanings.iter().enumerate() {
            match meaning {
                Meaning::Module(id) => found.push(Found::Module(*id)),
                Meaning::Item(id) => found.push(Found::Item(*id)),
                Meaning::Import(path) => {
                    let key = (module, name.to_owned(), place);
                    if asked.insert(key.clone()) {
                        found.extend(self.ends(module, path, asked));
                        asked.remove(&key);
                    }
                }
            }
        }
        if !meanings.is_empty() {
            return found;
        }
        for (place, path) in globs.iter().enumerate() {
            let key = (module, name.to_owned(), place);
            if !asked.insert(key.clone()) {
                continue;
            }
            for from in self.ends(module, path, asked) {
                match from {
                    Found::Module(id) => found.extend(self.look_up(id, name, asked)),
                    Found::Item(id) if self.items[id].associated.contains(name) => {
                        found.push(from);
                    }
                    Found::Item(_) => {}
                }
            }
            asked.remove(&key);
        }
        found
    }

    fn ends(&self, module: ModuleId, path: &[String], asked: &mut Asked) -> Vec<Found> {
        let found = self.resolve_from(module, path, asked);
        let whole = found.into_iter().filter(|(_, rest)| rest.is_empty());
        whole.map(|(found, _)| found).collect()
    }

    /// The type behind an alias, or the item itself.
    pub(super) fn behind(&self, item: ItemId) -> ItemId {
        let Some((module, path)) = &self.items[item].alias else {
            return item;
        };
        let ends = self.resolve(*module, path);
        let target = ends.into_iter().find_map(|(found, rest)| match found {
            Found::Item(id) if rest.is_empty() && id != item => Some(id),
            _ => None,
        });
        target.map_or(item, |id| self.behind(id))
    }
}
