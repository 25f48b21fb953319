//! Where a spec names things that it says elsewhere.

use super::places::{Item, Place, Places};
use super::site::{Sought, sites};
use crate::diagnostic::Faults;
use crate::syntax::{Sources, parse};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

/// Every place at which a thing is named, other than that which says it, in the order of the files.
#[derive(Clone, Debug, Default)]
pub struct Uses(Vec<Sought>);

/// Of a whole spec, as far as its files can be read as YAML.
#[must_use]
pub fn uses(sources: &Sources) -> Uses {
    let files: Vec<_> = sources.iter().filter(|(_, file)| file.whole).collect();
    let found: Vec<_> = files
        .par_iter()
        .map(|(id, file)| {
            let mut found = Vec::new();
            if let Some(tree) = parse(*id, &file.text, &mut Faults::new()) {
                sites(tree.root(), &mut |site| found.extend(site.sought()));
            }
            found
        })
        .collect();
    Uses(found.into_iter().flatten().collect())
}

impl Uses {
    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &Sought> {
        self.0.iter()
    }

    /// Those of one thing.
    pub fn of<'u>(&'u self, item: &'u Item) -> impl Iterator<Item = &'u Sought> {
        self.0.iter().filter(|sought| sought.is(item))
    }
}

impl Sought {
    /// Whether it is this thing.
    #[must_use]
    pub fn is(&self, item: &Item) -> bool {
        self.name == item.name && self.kinds.contains(&item.kind) && self.owner == item.owner
    }

    /// The thing, and where it is written; `None` if the spec does not have it.
    #[must_use]
    pub fn found<'p>(&self, places: &'p Places) -> Option<(Item, &'p Place)> {
        self.kinds.iter().find_map(|kind| {
            let item = Item {
                kind,
                owner: self.owner.clone(),
                name: self.name.clone(),
            };
            let place = places.get(&item)?;
            Some((item, place))
        })
    }
}
