//! The modules of a library or program, and what each name in them stands for.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::punctuated::Punctuated;
use syn::{Attribute, Ident, Item, Meta, Token, UseTree, Visibility};

use crate::run::Fault;

/// The text of a file, if it is there.
pub(super) type Reader<'a> = &'a dyn Fn(&Path) -> Option<String>;

/// A module, by its place in [`Tree::modules`].
pub(super) type ModuleId = usize;

/// An item, by its place in [`Tree::items`].
pub(super) type ItemId = usize;

/// All modules and items that come from one root.
#[derive(Default)]
pub(super) struct Tree {
    pub(super) modules: Vec<Module>,
    pub(super) items: Vec<Definition>,
}

/// A module, inline or with a file of its own.
#[derive(Default)]
pub(super) struct Module {
    pub(super) parent: Option<ModuleId>,
    pub(super) file: PathBuf,
    /// Where the files of its child modules stand.
    folder: PathBuf,
    is_inline: bool,
    /// What stands in it, tests apart.
    pub(super) source: Vec<Item>,
    /// What a name means here; it may mean several things (a type and a function).
    pub(super) names: BTreeMap<String, Vec<Meaning>>,
    /// The paths of its `use path::*`.
    pub(super) globs: Vec<Vec<String>>,
}

/// What a name stands for.
#[derive(Clone)]
pub(super) enum Meaning {
    Module(ModuleId),
    Item(ItemId),
    /// A `use` of this path.
    Import(Vec<String>),
}

/// What sort of thing an item is, as far as paths tell them apart.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Sort {
    Type,
    Value,
    Macro,
}

/// An item and the file that defines it.
pub(super) struct Definition {
    pub(super) name: String,
    pub(super) file: PathBuf,
    pub(super) sort: Sort,
    /// Where a type alias leads, and the module in which that is to be read.
    pub(super) alias: Option<(ModuleId, Vec<String>)>,
    /// Its variants, or the items of a trait.
    pub(super) associated: BTreeSet<String>,
    is_public: bool,
}

/// Keywords before the name of a type and of a value.
const TYPES: [&str; 5] = ["enum", "struct", "trait", "type", "union"];
const VALUES: [&str; 3] = ["const", "fn", "static"];

impl Tree {
    /// Reads the modules that begin in the file `root`.
    ///
    /// # Errors
    /// If a file is missing or is no Rust.
    pub(super) fn read(root: &Path, reader: Reader) -> Result<Self, Fault> {
        let mut tree = Self::default();
        let folder = root.parent().unwrap_or(root).to_owned();
        tree.read_file(None, root, folder, reader)?;
        Ok(tree)
    }

    /// The names of its public types and traits.
    pub(super) fn public_types(&self) -> BTreeSet<String> {
        let public = |item: &&Definition| item.is_public && item.sort == Sort::Type;
        let items = self.items.iter().filter(public);
        items.map(|item| item.name.clone()).collect()
    }

    fn read_file(
        &mut self,
        parent: Option<ModuleId>,
        file: &Path,
        folder: PathBuf,
        reader: Reader,
    ) -> Result<ModuleId, Fault> {
        let text = reader(file).ok_or_else(|| format!("{}: cannot be read", file.display()))?;
        let parsed = syn::parse_file(&text).map_err(|e| format!("{}: {e}", file.display()))?;
        let module = Module {
            parent,
            file: file.to_owned(),
            folder,
            ..Module::default()
        };
        self.read_module(module, parsed.items, reader)
    }

    fn read_module(
        &mut self,
        module: Module,
        source: Vec<Item>,
        reader: Reader,
    ) -> Result<ModuleId, Fault> {
        let id = self.modules.len();
        self.modules.push(module);
        let mut source = source;
        source.retain(|item| !is_test(attributes(item)));
        for item in &source {
            self.name(id, item, reader)?;
        }
        self.modules[id].source = source;
        Ok(id)
    }

    /// Enters the names that `item` brings into its module.
    fn name(&mut self, module: ModuleId, item: &Item, reader: Reader) -> Result<(), Fault> {
        let mut associated = BTreeSet::new();
        let mut alias = None;
        let (ident, visibility, sort) = match item {
            Item::Mod(child) => return self.read_child(module, child, reader),
            Item::Use(import) => {
                let imports = Imports::of(&import.tree);
                for (name, path) in imports.names {
                    self.mean(module, name, Meaning::Import(path));
                }
                self.modules[module].globs.extend(imports.globs);
                return Ok(());
            }
            Item::Macro(definition) => {
                let Some(ident) = &definition.ident else {
                    self.name_written(module, &definition.mac.tokens);
                    return Ok(());
                };
                (ident, &Visibility::Inherited, Sort::Macro)
            }
            Item::Enum(item) => {
                associated.extend(item.variants.iter().map(|v| v.ident.to_string()));
                (&item.ident, &item.vis, Sort::Type)
            }
            Item::Trait(item) => {
                associated.extend(item.items.iter().filter_map(trait_item));
                (&item.ident, &item.vis, Sort::Type)
            }
            Item::Type(item) => {
                if let syn::Type::Path(target) = &*item.ty {
                    alias = Some((module, segments(&target.path)));
                }
                (&item.ident, &item.vis, Sort::Type)
            }
            Item::Struct(item) => (&item.ident, &item.vis, Sort::Type),
            Item::Union(item) => (&item.ident, &item.vis, Sort::Type),
            Item::Fn(item) => (&item.sig.ident, &item.vis, Sort::Value),
            Item::Const(item) => (&item.ident, &item.vis, Sort::Value),
            Item::Static(item) => (&item.ident, &item.vis, Sort::Value),
            _ => return Ok(()),
        };
        let file = self.modules[module].file.clone();
        let name = ident.to_string();
        let definition = Definition {
            name: name.clone(),
            sort,
            alias,
            associated,
            is_public: matches!(visibility, Visibility::Public(_)),
            file,
        };
        let id = self.define(module, definition);
        if sort == Sort::Macro
            && attributes(item)
                .iter()
                .any(|a| a.path().is_ident("macro_export"))
        {
            self.mean(0, name, Meaning::Item(id));
        }
        Ok(())
    }

    /// Enters the items that a macro writes, as far as its `tokens` name them: after
    /// `pub`, with a keyword between or without.
    fn name_written(&mut self, module: ModuleId, tokens: &TokenStream) {
        let mut tokens = tokens.clone().into_iter().peekable();
        while let Some(token) = tokens.next() {
            if !matches!(&token, TokenTree::Ident(ident) if ident == "pub") {
                continue;
            }
            let restricted = tokens.next_if(|token| matches!(token, TokenTree::Group(_)));
            let keyword = tokens.next_if(|token| {
                let text = token.to_string();
                TYPES.contains(&text.as_str()) || VALUES.contains(&text.as_str())
            });
            let Some(TokenTree::Ident(name)) = tokens.next() else {
                continue;
            };
            let is_value = keyword.is_some_and(|word| VALUES.contains(&word.to_string().as_str()));
            let definition = Definition {
                name: name.to_string(),
                file: self.modules[module].file.clone(),
                sort: if is_value { Sort::Value } else { Sort::Type },
                alias: None,
                associated: BTreeSet::new(),
                is_public: restricted.is_none(),
            };
            self.define(module, definition);
        }
    }

    fn define(&mut self, module: ModuleId, definition: Definition) -> ItemId {
        let id = self.items.len();
        self.mean(module, definition.name.clone(), Meaning::Item(id));
        self.items.push(definition);
        id
    }

    fn read_child(
        &mut self,
        parent: ModuleId,
        child: &syn::ItemMod,
        reader: Reader,
    ) -> Result<(), Fault> {
        let name = child.ident.to_string();
        let Module {
            file,
            folder,
            is_inline,
            ..
        } = &self.modules[parent];
        // Of a path attribute: the folder of the file, unless an inline module
        // stands between.
        let from = file.parent().filter(|_| !is_inline).unwrap_or(folder);
        let attribute = path_attribute(&child.attrs).map(|path| plain(&from.join(path)));
        let nested = folder.join(&name);
        let id = if let Some((_, source)) = &child.content {
            let inline = Module {
                parent: Some(parent),
                file: file.clone(),
                folder: attribute.unwrap_or(nested),
                is_inline: true,
                ..Module::default()
            };
            self.read_module(inline, source.clone(), reader)?
        } else if let Some(at) = attribute {
            let folder = at.parent().unwrap_or(folder).to_owned();
            self.read_file(Some(parent), &at, folder, reader)?
        } else {
            let beside = folder.join(format!("{name}.rs"));
            let at = if reader(&beside).is_some() {
                beside
            } else {
                nested.join("mod.rs")
            };
            self.read_file(Some(parent), &at, nested, reader)?
        };
        self.mean(parent, name, Meaning::Module(id));
        Ok(())
    }

    fn mean(&mut self, module: ModuleId, name: String, meaning: Meaning) {
        let names = &mut self.modules[module].names;
        names.entry(name).or_default().push(meaning);
    }
}

/// `path` without `x/..`, so that a file has one name.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        if part.as_os_str() == ".." {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes
        .iter()
        .find_map(|attribute| match &attribute.meta {
            Meta::NameValue(meta) if meta.path.is_ident("path") => match &meta.value {
                syn::Expr::Lit(syn::ExprLit {
                    lit: syn::Lit::Str(path),
                    ..
                }) => Some(path.value()),
                _ => None,
            },
            _ => None,
        })
}

/// Whether what carries `attributes` is compiled for tests alone.
pub(super) fn is_test(attributes: &[Attribute]) -> bool {
    fn wants_test(meta: &Meta) -> bool {
        match meta {
            Meta::Path(path) => path.is_ident("test"),
            Meta::List(list) if list.path.is_ident("all") => list
                .parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)
                .is_ok_and(|all| all.iter().any(wants_test)),
            _ => false,
        }
    }
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute
                    .parse_args::<Meta>()
                    .is_ok_and(|meta| wants_test(&meta))
    })
}

pub(super) fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

fn trait_item(item: &syn::TraitItem) -> Option<String> {
    match item {
        syn::TraitItem::Const(item) => Some(item.ident.to_string()),
        syn::TraitItem::Fn(item) => Some(item.sig.ident.to_string()),
        syn::TraitItem::Type(item) => Some(item.ident.to_string()),
        _ => None,
    }
}

/// The names of a path, without their generics.
pub(super) fn segments(path: &syn::Path) -> Vec<String> {
    let names = path.segments.iter().map(|part| part.ident.to_string());
    path.leading_colon
        .iter()
        .map(|_| String::new())
        .chain(names)
        .collect()
}

/// What a `use` brings in.
#[derive(Default)]
pub(super) struct Imports {
    /// Names, with the paths they stand for.
    pub(super) names: Vec<(String, Vec<String>)>,
    /// The paths before `::*`.
    pub(super) globs: Vec<Vec<String>>,
}

impl Imports {
    pub(super) fn of(tree: &UseTree) -> Self {
        let mut imports = Self::default();
        imports.walk(tree, &[]);
        imports
    }

    fn walk(&mut self, tree: &UseTree, before: &[String]) {
        let with = |ident: &Ident| {
            // `use a::b::{self}` is `use a::b`.
            let is_self = ident == "self" && !before.is_empty();
            let name = (!is_self).then(|| ident.to_string());
            before.iter().cloned().chain(name).collect::<Vec<_>>()
        };
        match tree {
            UseTree::Path(path) => self.walk(&path.tree, &with(&path.ident)),
            UseTree::Name(name) => {
                let path = with(&name.ident);
                self.names
                    .push((path.last().cloned().unwrap_or_default(), path));
            }
            UseTree::Rename(rename) => {
                let path = with(&rename.ident);
                self.names.push((rename.rename.to_string(), path));
            }
            UseTree::Glob(_) => self.globs.push(before.to_vec()),
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.walk(tree, before);
                }
            }
        }
    }
}
