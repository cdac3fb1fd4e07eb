//! The arrows that the paths of a program draw between its files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Item, ItemImpl, UseTree, Visibility};

use super::circles::Arrows;
use super::names::Found;
use super::tree::{Imports, ItemId, ModuleId, Sort, Tree, attributes, is_test, segments};

/// Adds the arrows between the files of `tree` to `arrows`.
pub(super) fn arrows(tree: &Tree, arrows: &mut Arrows) {
    let impls = impls(tree);
    for module in 0..tree.modules.len() {
        let mut paths = Paths {
            tree,
            module,
            impls: &impls,
            arrows,
            own: None,
            scopes: Vec::new(),
        };
        for item in &tree.modules[module].source {
            paths.visit_item(item);
        }
    }
}

/// In which files each type has its items of `impl` blocks, by their names.
type Impls = BTreeMap<(ItemId, String), Places>;

#[derive(Default)]
struct Places {
    /// Items of the type's own `impl` blocks.
    inherent: BTreeSet<PathBuf>,
    /// Items that it has by a trait.
    by_trait: BTreeSet<PathBuf>,
}

fn impls(tree: &Tree) -> Impls {
    let mut impls = Impls::new();
    for (id, module) in tree.modules.iter().enumerate() {
        for item in &module.source {
            let Item::Impl(block) = item else { continue };
            let Some(own) = own_type(tree, id, block) else {
                continue;
            };
            for item in &block.items {
                let name = match item {
                    syn::ImplItem::Const(item) => &item.ident,
                    syn::ImplItem::Fn(item) => &item.sig.ident,
                    syn::ImplItem::Type(item) => &item.ident,
                    _ => continue,
                };
                let places = impls.entry((own, name.to_string())).or_default();
                match &block.trait_ {
                    None => places.inherent.insert(module.file.clone()),
                    Some(_) => places.by_trait.insert(module.file.clone()),
                };
            }
        }
    }
    impls
}

/// The type of the crate for which `block` is.
fn own_type(tree: &Tree, module: ModuleId, block: &ItemImpl) -> Option<ItemId> {
    let syn::Type::Path(own) = &*block.self_ty else {
        return None;
    };
    let path = segments(&own.path);
    let found = tree.resolve(module, &path).into_iter();
    let mut types = found.filter_map(|(found, rest)| match found {
        Found::Item(id) if rest.is_empty() && tree.items[id].sort == Sort::Type => Some(id),
        _ => None,
    });
    types.next().map(|id| tree.behind(id))
}

/// Visits one module's items and draws what they name.
struct Paths<'a> {
    tree: &'a Tree,
    module: ModuleId,
    impls: &'a Impls,
    arrows: &'a mut Arrows,
    /// What `Self` is.
    own: Option<ItemId>,
    /// Names of blocks: those that a `use` brings in, and generic parameters, which
    /// hide the module's and lead nowhere.
    scopes: Vec<BTreeMap<String, Option<Vec<String>>>>,
}

impl Paths<'_> {
    /// Draws the arrows of one path. `wanted` says which sorts of item it can mean.
    fn draw(&mut self, path: &[String], wanted: impl Fn(Sort) -> bool) {
        let Some(first) = path.first() else { return };
        if first == "Self" {
            if let (Some(own), Some(name)) = (self.own, path.get(1)) {
                self.draw_associated(own, name);
            }
            return;
        }
        let local = self.scopes.iter().rev().find_map(|scope| scope.get(first));
        let path = match local {
            Some(None) => return,
            Some(Some(import)) => [import, &path[1..]].concat(),
            None => path.to_vec(),
        };
        for (found, rest) in self.tree.resolve(self.module, &path) {
            let Found::Item(item) = found else { continue };
            let sort = self.tree.items[item].sort;
            if rest.is_empty() && !wanted(sort) {
                continue;
            }
            self.draw_item(item);
            if let Some(name) = rest.first() {
                self.draw_associated(self.tree.behind(item), name);
            }
        }
    }

    fn draw_item(&mut self, item: ItemId) {
        let item = &self.tree.items[item];
        self.draw_to(item.file.clone(), item.name.clone());
    }

    fn draw_associated(&mut self, own: ItemId, name: &str) {
        let Some(places) = self.impls.get(&(own, name.to_owned())) else {
            return;
        };
        // Which of several traits is meant, a path does not tell.
        let files = match (places.inherent.len(), places.by_trait.len()) {
            (0, 1) => &places.by_trait,
            _ => &places.inherent,
        };
        for file in files {
            let own = &self.tree.items[own].name;
            self.draw_to(file.clone(), format!("{own}::{name}"));
        }
    }

    fn draw_to(&mut self, file: PathBuf, name: String) {
        let here = self.tree.modules[self.module].file.clone();
        if file != here {
            self.arrows.entry((here, file)).or_default().insert(name);
        }
    }

    /// Draws what a macro of this name in reach leads to.
    fn draw_macro(&mut self, path: &[String]) {
        self.draw(path, |sort| sort == Sort::Macro);
        if let [name] = path {
            // By the order of the text, without a path.
            let named = |&id: &ItemId| {
                let item = &self.tree.items[id];
                item.sort == Sort::Macro && item.name == *name
            };
            for id in (0..self.tree.items.len()).filter(named) {
                self.draw_item(id);
            }
        }
    }

    /// Draws what the tokens of a macro look like paths to.
    fn tokens(&mut self, tokens: &TokenStream) {
        let tokens: Vec<_> = tokens.clone().into_iter().collect();
        let is = |at: usize, sign: char| matches!(tokens.get(at), Some(TokenTree::Punct(p)) if p.as_char() == sign);
        let mut at = 0;
        while at < tokens.len() {
            match &tokens[at] {
                TokenTree::Group(group) => self.tokens(&group.stream()),
                TokenTree::Ident(first) => {
                    let start = at;
                    let mut path = vec![first.to_string()];
                    while is(at + 1, ':') && is(at + 2, ':') {
                        let Some(TokenTree::Ident(next)) = tokens.get(at + 3) else {
                            break;
                        };
                        path.push(next.to_string());
                        at += 3;
                    }
                    // After a dot a field or a method, after `::` the rest of a type.
                    let dot = start > 0 && is(start - 1, '.') && !(start > 1 && is(start - 2, '.'));
                    if dot || start > 0 && is(start - 1, ':') && start > 1 && is(start - 2, ':') {
                    } else if is(at + 1, '!') {
                        self.draw_macro(&path);
                    } else if path.len() > 1 || path[0].starts_with(char::is_uppercase) {
                        self.draw(&path, |sort| sort != Sort::Macro);
                    }
                }
                _ => {}
            }
            at += 1;
        }
    }

    /// Runs `inside` with the names of a block or of generics in scope.
    fn within(
        &mut self,
        names: BTreeMap<String, Option<Vec<String>>>,
        inside: impl FnOnce(&mut Self),
    ) {
        self.scopes.push(names);
        inside(self);
        self.scopes.pop();
    }
}

/// The names of generic parameters, which hide the module's.
fn parameters(generics: &syn::Generics) -> BTreeMap<String, Option<Vec<String>>> {
    let names = generics
        .params
        .iter()
        .filter_map(|parameter| match parameter {
            syn::GenericParam::Type(parameter) => Some(&parameter.ident),
            syn::GenericParam::Const(parameter) => Some(&parameter.ident),
            syn::GenericParam::Lifetime(_) => None,
        });
    names.map(|name| (name.to_string(), None)).collect()
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if is_test(attributes(item)) {
            return;
        }
        let generics = match item {
            Item::Enum(item) => parameters(&item.generics),
            Item::Impl(item) => parameters(&item.generics),
            Item::Struct(item) => parameters(&item.generics),
            Item::Trait(item) => parameters(&item.generics),
            Item::Type(item) => parameters(&item.generics),
            _ => BTreeMap::new(),
        };
        self.within(generics, |paths| visit::visit_item(paths, item));
    }

    /// A module has its own visit.
    fn visit_item_mod(&mut self, _: &'ast syn::ItemMod) {}

    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_item_use(&mut self, import: &'ast syn::ItemUse) {
        if matches!(import.vis, Visibility::Inherited) {
            self.visit_use_tree(&import.tree);
        }
    }

    fn visit_use_tree(&mut self, tree: &'ast UseTree) {
        for (_, path) in Imports::of(tree).names {
            // In the module, so that the names of a block do not hide their own paths.
            let scopes = std::mem::take(&mut self.scopes);
            self.draw(&path, |_| true);
            self.scopes = scopes;
        }
    }

    fn visit_item_impl(&mut self, block: &'ast ItemImpl) {
        let before = self.own;
        self.own = own_type(self.tree, self.module, block);
        visit::visit_item_impl(self, block);
        self.own = before;
    }

    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        let generics = parameters(&function.sig.generics);
        self.within(generics, |paths| visit::visit_item_fn(paths, function));
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_test(&function.attrs) {
            let generics = parameters(&function.sig.generics);
            self.within(generics, |paths| visit::visit_impl_item_fn(paths, function));
        }
    }

    fn visit_block(&mut self, block: &'ast syn::Block) {
        let mut names = BTreeMap::new();
        for statement in &block.stmts {
            if let syn::Stmt::Item(Item::Use(import)) = statement {
                let imported = Imports::of(&import.tree).names;
                names.extend(imported.into_iter().map(|(name, path)| (name, Some(path))));
            }
        }
        self.within(names, |paths| visit::visit_block(paths, block));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.draw(&segments(path), |sort| sort != Sort::Macro);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.draw_macro(&segments(&call.path));
        self.tokens(&call.tokens);
    }
}
