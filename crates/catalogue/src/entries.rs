//! The catalogue without types: what the tree, the scene language and the reference listing look entries up in.

use super::*;
use std::sync::LazyLock;

/// A primitive of the catalogue.
#[derive(Debug)]
pub struct PrimitiveEntry {
    /// Name, parameters, words.
    pub info: Info,
    /// How true its distance is.
    pub exactness: Exactness,
    /// More parameter sets worth a proof.
    pub samples: &'static [&'static [f64]],
    /// Place in the list: the instruction's code.
    pub code: u16,
    /// See [`Primitive::bounds`].
    pub bounds: fn(&[f64]) -> Aabb,
    /// See [`Primitive::level_bounds`].
    pub level_bounds: fn(&[f64], f64) -> Aabb,
    /// See [`Primitive::lipschitz`].
    pub lipschitz: fn(&[f64]) -> f64,
    /// See [`Primitive::contains`].
    pub contains: fn(&[f64], [f64; 3]) -> bool,
    /// See [`Primitive::check`].
    pub check: fn(&[f64]) -> Result<(), String>,
}

/// A map of the catalogue.
#[derive(Debug)]
pub struct MapEntry {
    /// Name, parameters, words.
    pub info: Info,
    /// Whether it takes a solid and gives a 2D field.
    pub section: bool,
    /// Whether an exact distance stays exact.
    pub rigid: bool,
    /// More parameter sets worth a proof.
    pub samples: &'static [&'static [f64]],
    /// Place in the list: the instruction's code.
    pub code: u16,
    /// See [`Map::stretch`].
    pub stretch: fn(&[f64], &Aabb) -> Result<Stretch, String>,
    /// See [`Map::bounds`].
    pub bounds: fn(&[f64], &Aabb) -> Aabb,
    /// See [`Map::plane`].
    pub plane: fn(&[f64]) -> Result<(), String>,
    /// See [`Map::check`].
    pub check: fn(&[f64]) -> Result<(), String>,
}

/// A box of a level set, from the parameters, the level, and boxes of the level sets of what is changed.
pub type ModifyBounds = fn(&[f64], f64, &dyn Fn(f64) -> Aabb) -> Aabb;
/// A box of a level set, from the parameters, the level, and boxes of the level sets of what is joined.
pub type JoinBounds = fn(&[f64], f64, &dyn Fn(f64) -> Aabb, &dyn Fn(f64) -> Aabb) -> Aabb;

/// A modifier of the catalogue.
#[derive(Debug)]
pub struct ModifyEntry {
    /// Name, parameters, words.
    pub info: Info,
    /// More parameter sets worth a proof.
    pub samples: &'static [&'static [f64]],
    /// Place in the list: the instruction's code.
    pub code: u16,
    /// See [`Modify::lipschitz`].
    pub lipschitz: fn(&[f64], f64) -> f64,
    /// See [`Modify::level_bounds`].
    pub level_bounds: ModifyBounds,
    /// See [`Modify::exactness`].
    pub exactness: fn(Exactness) -> Exactness,
    /// See [`Modify::check`].
    pub check: fn(&[f64]) -> Result<(), String>,
}

/// A join of the catalogue.
#[derive(Debug)]
pub struct JoinEntry {
    /// Name, parameters, words.
    pub info: Info,
    /// See [`Join::SHARP`].
    pub sharp: bool,
    /// See [`Join::ASSOCIATIVE`].
    pub associative: bool,
    /// More parameter sets worth a proof.
    pub samples: &'static [&'static [f64]],
    /// Place in the list: the instruction's code.
    pub code: u16,
    /// See [`Join::lipschitz`].
    pub lipschitz: fn(&[f64], f64, f64) -> f64,
    /// See [`Join::fold_bounds`].
    pub bounds: fn(&[f64], &[Aabb]) -> Aabb,
    /// See [`Join::level_bounds`].
    pub level_bounds: JoinBounds,
    /// See [`Join::exactness`].
    pub exactness: fn(Exactness, Exactness) -> Exactness,
    /// See [`Join::reach`].
    pub reach: fn(&[f64]) -> f64,
    /// See [`Join::contains`].
    pub contains: fn(bool, bool) -> bool,
    /// See [`Join::check`].
    pub check: fn(&[f64]) -> Result<(), String>,
}

/// All entries, each kind in the order of its list.
pub struct Catalogue {
    /// Shapes.
    pub primitives: Vec<PrimitiveEntry>,
    /// Maps of space.
    pub maps: Vec<MapEntry>,
    /// Changes of one field.
    pub modifiers: Vec<ModifyEntry>,
    /// Two fields made one.
    pub joins: Vec<JoinEntry>,
}

macro_rules! gather {
    ($kind:ident $($entry:path,)*) => { vec![$($kind::<$entry>()),*] };
}

/// The catalogue.
pub fn catalogue() -> &'static Catalogue {
    static ALL: LazyLock<Catalogue> = LazyLock::new(|| {
        let mut all = Catalogue {
            primitives: crate::each_primitive!(gather primitive),
            maps: crate::each_map!(gather map),
            modifiers: crate::each_modify!(gather modifier),
            joins: crate::each_join!(gather join),
        };
        all.primitives
            .iter_mut()
            .zip(0..)
            .for_each(|(e, i)| e.code = i);
        all.maps.iter_mut().zip(0..).for_each(|(e, i)| e.code = i);
        all.modifiers
            .iter_mut()
            .zip(0..)
            .for_each(|(e, i)| e.code = i);
        all.joins.iter_mut().zip(0..).for_each(|(e, i)| e.code = i);
        all
    });
    &ALL
}

impl Catalogue {
    /// The primitive of this name.
    pub fn primitive(&self, name: &str) -> Option<&PrimitiveEntry> {
        self.primitives.iter().find(|e| e.info.name == name)
    }

    /// The map of this name.
    pub fn map(&self, name: &str) -> Option<&MapEntry> {
        self.maps.iter().find(|e| e.info.name == name)
    }

    /// The modifier of this name.
    pub fn modifier(&self, name: &str) -> Option<&ModifyEntry> {
        self.modifiers.iter().find(|e| e.info.name == name)
    }

    /// The join of this name.
    pub fn join(&self, name: &str) -> Option<&JoinEntry> {
        self.joins.iter().find(|e| e.info.name == name)
    }

    /// The sharp union, which is always there.
    pub fn union() -> &'static JoinEntry {
        static UNION: LazyLock<JoinEntry> = LazyLock::new(|| JoinEntry {
            code: 0,
            ..join::<super::join::Union>()
        });
        &UNION
    }

    /// What every entry says of itself, kind by kind.
    pub fn infos(&self) -> impl Iterator<Item = &Info> {
        (self.primitives.iter().map(|e| &e.info))
            .chain(self.maps.iter().map(|e| &e.info))
            .chain(self.modifiers.iter().map(|e| &e.info))
            .chain(self.joins.iter().map(|e| &e.info))
    }
}

fn primitive<E: Primitive>() -> PrimitiveEntry {
    PrimitiveEntry {
        info: E::INFO,
        exactness: E::EXACTNESS,
        samples: E::SAMPLES,
        code: 0,
        bounds: E::bounds,
        level_bounds: E::level_bounds,
        lipschitz: E::lipschitz,
        contains: E::contains,
        check: E::check,
    }
}

fn map<E: Map>() -> MapEntry {
    MapEntry {
        info: E::INFO,
        section: E::SECTION,
        rigid: E::RIGID,
        samples: E::SAMPLES,
        code: 0,
        stretch: E::stretch,
        bounds: E::bounds,
        plane: E::plane,
        check: E::check,
    }
}

fn modifier<E: Modify>() -> ModifyEntry {
    ModifyEntry {
        info: E::INFO,
        samples: E::SAMPLES,
        code: 0,
        lipschitz: E::lipschitz,
        level_bounds: E::level_bounds,
        exactness: E::exactness,
        check: E::check,
    }
}

fn join<E: Join>() -> JoinEntry {
    JoinEntry {
        info: E::INFO,
        sharp: E::SHARP,
        associative: E::ASSOCIATIVE,
        samples: E::SAMPLES,
        code: 0,
        lipschitz: E::lipschitz,
        bounds: E::fold_bounds,
        level_bounds: E::level_bounds,
        exactness: E::exactness,
        reach: E::reach,
        contains: E::contains,
        check: E::check,
    }
}
