//! The registry of methods: everything of which a rendering chooses one, as the catalogue is of fields.
//!
//! A method is defined once, in a `choice!` of [`crate::settings`] or [`crate::film`]: its name, who invented it, and its
//! parameters with default, range and unit. The scene language, JSON, the command line, the window, the reference and the
//! tests iterate what is here; renderers match the enums themselves, so that a method that one does not have does not
//! compile.

use crate::film::Plane;
use crate::settings::{
    Antialias, Filter, Integrator, March, Normals, Occlusion, Shading, Shadow, Tone,
};
use std::fmt;
use zeroset_catalogue::{LARGE, SMALL};

/// A method among those of its kind.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Its name in JSON and on the command line.
    pub name: &'static str,
    /// Its name in the scene language, which is another one where a shape has that name.
    pub word: &'static str,
    /// Its name for people.
    pub title: &'static str,
    /// Author, year and section; what it is made of where it is nobody's idea.
    pub source: &'static str,
    /// What it does, on one line.
    pub doc: &'static str,
    /// Its numbers, in the order in which the scene language takes them.
    pub params: &'static [Param],
}

/// A parameter of a method.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Its name in the scene language, in JSON and on the command line.
    pub name: &'static str,
    /// Its name for people.
    pub title: &'static str,
    /// What it means, on one line.
    pub doc: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// What it is where nothing is said.
    pub default: Value,
    /// Which numbers it takes.
    pub allowed: Allowed,
    /// Between which numbers good ones lie: what a slider shows.
    pub usual: (f64, f64),
    /// What it measures.
    pub unit: Unit,
    /// Whether equal ratios are equally far apart on a slider.
    pub is_logarithmic: bool,
}

/// What a parameter takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A number.
    Real,
    /// A whole number.
    Whole,
    /// A number, or none at all: no limit.
    Limit,
    /// One of some methods.
    Word(&'static [Method]),
}

/// A value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Real(f32),
    /// A whole number.
    Whole(u32),
    /// A number, or none at all: no limit.
    Limit(Option<f32>),
    /// The place of a method among those of its kind.
    Word(usize),
}

/// What a parameter measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Scene units.
    Length,
    /// The inverse of a length.
    PerLength,
    /// Nothing: a share or a factor.
    Ratio,
    /// A number of things.
    Count,
    /// Pixels of the picture.
    Pixels,
    /// Stops: each doubles the light.
    Stops,
}

impl Unit {
    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Unit::Length => "scene units",
            Unit::PerLength => "per scene unit",
            Unit::Ratio => "ratio",
            Unit::Count => "count",
            Unit::Pixels => "pixels",
            Unit::Stops => "stops",
        }
    }
}

/// The numbers from one to another, of which an end may be left out. Numbers are compared in single precision, in which they
/// are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowed {
    /// The least, or what all are above.
    pub min: f64,
    /// The largest, or what all are below.
    pub max: f64,
    /// Whether the least is not one of them.
    pub is_above: bool,
    /// Whether the largest is not one of them.
    pub is_below: bool,
}

impl Allowed {
    /// Both ends are allowed.
    pub const fn between(min: f64, max: f64) -> Allowed {
        Allowed {
            min,
            max,
            is_above: false,
            is_below: false,
        }
    }

    /// The least is not allowed, the largest is.
    pub const fn above(min: f64, max: f64) -> Allowed {
        Allowed {
            is_above: true,
            ..Allowed::between(min, max)
        }
    }

    /// The least is allowed, the largest is not.
    pub const fn below(min: f64, max: f64) -> Allowed {
        Allowed {
            is_below: true,
            ..Allowed::between(min, max)
        }
    }

    /// Whether a number is one of them.
    pub fn holds(&self, x: f32) -> bool {
        let (min, max) = (self.min as f32, self.max as f32);
        let low = if self.is_above { x > min } else { x >= min };
        let high = if self.is_below { x < max } else { x <= max };
        low && high
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let above = if self.is_above { "above " } else { "" };
        let below = if self.is_below { "below " } else { "" };
        write!(
            f,
            "{above}{} to {below}{}",
            Spoken(self.min),
            Spoken(self.max)
        )
    }
}

/// A number as a person writes it.
struct Spoken<X>(X);

impl<X: Copy + Into<f64> + fmt::Display + fmt::LowerExp> fmt::Display for Spoken<X> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let x: f64 = self.0.into();
        if x == 0.0 || (1e-4..1e7).contains(&x.abs()) || !x.is_finite() {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

/// Why a parameter does not take a value, as what is said of it: `is 2, allowed is 1 to below 2`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(String);

impl Param {
    /// A number that any of [`Allowed`] can be, `usual` being all of them.
    pub(crate) const fn new(title: &'static str, unit: Unit, allowed: Allowed) -> Param {
        Param {
            name: "",
            title,
            doc: "",
            kind: Kind::Real,
            default: Value::Real(0.0),
            allowed,
            usual: (allowed.min, allowed.max),
            unit,
            is_logarithmic: false,
        }
    }

    /// With the range of a slider.
    pub(crate) const fn usual(self, min: f64, max: f64) -> Param {
        Param {
            usual: (min, max),
            ..self
        }
    }

    /// With a slider on which equal ratios are equally far apart.
    pub(crate) const fn logarithmic(self) -> Param {
        Param {
            is_logarithmic: true,
            ..self
        }
    }

    /// The same where at most so many samples are allowed, but one in any case: whole numbers of methods count them.
    pub fn within(self, samples: u64) -> Param {
        if !matches!(self.kind, Kind::Whole) {
            return self;
        }
        let most = (self.allowed.max.min(samples as f64)).max(self.allowed.min);
        let allowed = Allowed {
            max: most,
            ..self.allowed
        };
        let default = match self.default {
            Value::Whole(n) => Value::Whole(n.min(most as u32)),
            other => other,
        };
        Param {
            allowed,
            default,
            ..self
        }
    }

    /// The value that a number is.
    ///
    /// # Errors
    /// The number is not allowed, or a whole one is needed and it is none, or a word is needed.
    pub fn value(&self, x: f64) -> Result<Value, Refused> {
        if !self.allowed.holds(x as f32) {
            return Err(self.outside(Spoken(x)));
        }
        match self.kind {
            Kind::Real => Ok(Value::Real(x as f32)),
            Kind::Limit => Ok(Value::Limit(Some(x as f32))),
            Kind::Whole if x.fract() == 0.0 => Ok(Value::Whole(x as u32)),
            Kind::Whole => Err(Refused(format!(
                "must be a whole number, not {}",
                Spoken(x)
            ))),
            Kind::Word(_) => Err(Refused("must be a word".to_owned())),
        }
    }

    /// The value that a word is, if it takes words and this is one of them.
    pub fn word(&self, text: &str) -> Option<Value> {
        let Kind::Word(methods) = self.kind else {
            return None;
        };
        methods.iter().position(|m| m.name == text).map(Value::Word)
    }

    /// Whether it may have a value.
    ///
    /// # Errors
    /// The value is not allowed, or of another kind.
    pub fn check(&self, value: Value) -> Result<(), Refused> {
        let other = || Err(Refused("is of another kind".to_owned()));
        match (self.kind, value) {
            (Kind::Limit, Value::Limit(None)) => Ok(()),
            (Kind::Real, Value::Real(x)) | (Kind::Limit, Value::Limit(Some(x))) => {
                if self.allowed.holds(x) {
                    Ok(())
                } else {
                    Err(self.outside(Spoken(x)))
                }
            }
            (Kind::Whole, Value::Whole(n)) => {
                if (self.allowed.min..=self.allowed.max).contains(&f64::from(n)) {
                    Ok(())
                } else {
                    Err(self.outside(n))
                }
            }
            (Kind::Word(methods), Value::Word(place)) if place < methods.len() => Ok(()),
            (Kind::Real | Kind::Limit | Kind::Whole | Kind::Word(_), _) => other(),
        }
    }

    fn outside(&self, x: impl fmt::Display) -> Refused {
        Refused(format!("is {x}, allowed is {}", self.allowed))
    }

    /// A value as a scene writes it.
    pub fn written(&self, value: Value) -> String {
        match (value, self.kind) {
            (Value::Real(x) | Value::Limit(Some(x)), _) => Spoken(x).to_string(),
            (Value::Limit(None), _) => "unlimited".to_owned(),
            (Value::Whole(n), _) => n.to_string(),
            (Value::Word(place), Kind::Word(methods)) => {
                (methods.get(place)).map_or_else(String::new, |m| format!("\"{}\"", m.name))
            }
            (Value::Word(_), Kind::Real | Kind::Whole | Kind::Limit) => String::new(),
        }
    }
}

/// A choice among methods: an enum with a variant for each, whose fields are its parameters.
pub trait Choice: Copy + PartialEq + fmt::Debug + Default + Send + Sync + 'static {
    /// What the scene language calls the choice: `march` in `render(march = auto())`.
    const KEY: &'static str;
    /// What a method of this kind is, with its article.
    const WHAT: &'static str;
    /// The kind for people, as a heading.
    const TITLE: &'static str;
    /// All methods; the first is the default.
    const METHODS: &'static [Method];

    /// All methods with the defaults of their parameters, in the same order.
    fn all() -> &'static [Self];

    /// Where in the list this one is.
    fn place(&self) -> usize;

    /// A parameter; none if the method has none of this name.
    fn get(&self, param: &str) -> Option<Value>;

    /// Puts a value into a parameter without looking at its range; gives whether there is such a parameter, of such a kind.
    fn put(&mut self, param: &str, value: Value) -> bool;

    /// What is known of this one.
    fn method(&self) -> &'static Method {
        &Self::METHODS[self.place()]
    }

    /// The method that has a name, in JSON or in the scene language, with the defaults of its parameters.
    fn named(name: &str) -> Option<Self> {
        let place = (Self::METHODS.iter()).position(|m| m.name == name || m.word == name)?;
        Self::all().get(place).copied()
    }

    /// Puts a value into a parameter.
    ///
    /// # Errors
    /// There is no such parameter, or it does not take the value.
    fn set(&mut self, param: &str, value: Value) -> Result<(), Refused> {
        let Some(found) = self.method().params.iter().find(|p| p.name == param) else {
            return Err(Refused("is no parameter of this method".to_owned()));
        };
        found.check(value)?;
        self.put(param, value);
        Ok(())
    }

    /// Whether all parameters are in their ranges, and whole ones at most the number of samples that is allowed.
    ///
    /// # Errors
    /// The first parameter that is not, and why.
    fn check(&self, samples: u64) -> Result<(), (&'static str, Refused)> {
        for param in self.method().params {
            if let Some(value) = self.get(param.name) {
                (param.within(samples).check(value)).map_err(|refused| (param.name, refused))?;
            }
        }
        Ok(())
    }
}

/// A kind of methods as data.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// See [`Choice::KEY`].
    pub key: &'static str,
    /// See [`Choice::WHAT`].
    pub what: &'static str,
    /// See [`Choice::TITLE`].
    pub title: &'static str,
    /// See [`Choice::METHODS`].
    pub methods: &'static [Method],
}

impl Group {
    /// The kind of a choice.
    pub const fn of<T: Choice>() -> Group {
        Group {
            key: T::KEY,
            what: T::WHAT,
            title: T::TITLE,
            methods: T::METHODS,
        }
    }

    /// Whether its methods are functions of the scene language; else they are words.
    pub fn is_called(&self) -> bool {
        self.methods.iter().any(|m| !m.params.is_empty())
    }
}

/// Every kind of methods.
pub const GROUPS: [Group; 10] = [
    Group::of::<March>(),
    Group::of::<Normals>(),
    Group::of::<Shadow>(),
    Group::of::<Occlusion>(),
    Group::of::<Shading>(),
    Group::of::<Integrator>(),
    Group::of::<Tone>(),
    Group::of::<Antialias>(),
    Group::of::<Filter>(),
    Group::of::<Plane>(),
];

/// Any length that is not zero.
pub(crate) const LENGTH: Allowed = Allowed::between(SMALL, LARGE);
/// Samples that a method may take, where a scene's limits do not say less.
pub(crate) const SAMPLES: Allowed = Allowed::between(1.0, (1 << 20) as f64);

/// A parameter that may have no limit, as a field of a method.
pub(crate) type Limit = Option<f32>;

/// Defines a choice: an enum, and what [`Choice`] says of it. A variant is written as
/// `Name("name" as "word in the language", "Title", "source") { field: type = default, param; ... }`, its doc and those of
/// its fields being what people read of them. The type of a field is `f32`, `u32`, `Limit`, or another choice whose methods
/// have no parameters. The first variant is the default.
macro_rules! choice {
    (
        $(#[$meta:meta])*
        $vis:vis enum $name:ident($key:literal, $what:literal, $heading:literal) {
            $(
                $(#[doc = $doc:literal])+
                $variant:ident($called:literal $(as $word:literal)?, $title:literal, $source:literal) $({
                    $(
                        $(#[doc = $about:literal])+
                        $(#[serde($($serde:tt)*)])?
                        $field:ident: $type:ident = $default:expr, $param:expr
                    );+ $(;)?
                })?
            ),+ $(,)?
        }
    ) => {
        $(#[$meta])*
        $vis enum $name {
            $(
                $(#[doc = $doc])+
                #[doc = concat!("(", $source, ")")]
                #[serde(rename = $called)]
                $variant $({
                    $(
                        $(#[doc = $about])+
                        #[doc = ""]
                        #[doc = concat!(
                            "Default: `",
                            stringify!($default),
                            "`. Range and unit: see [`METHODS`](crate::methods::Choice::METHODS)."
                        )]
                        $(#[serde($($serde)*)])?
                        $field: $type,
                    )+
                })?,
            )+
        }

        impl $name {
            /// All methods with the defaults of their parameters.
            pub const ALL: [$name; [$($called),+].len()] = [
                $($name::$variant { $($($field: $default),+)? }),+
            ];
        }

        impl Default for $name {
            fn default() -> $name {
                $name::ALL[0]
            }
        }

        impl $crate::methods::Choice for $name {
            const KEY: &'static str = $key;
            const WHAT: &'static str = $what;
            const TITLE: &'static str = $heading;
            const METHODS: &'static [$crate::methods::Method] = &[
                $($crate::methods::Method {
                    name: $called,
                    word: $crate::methods::choice!(@word $called $(, $word)?),
                    title: $title,
                    source: $source,
                    doc: concat!($($doc),+).trim_ascii_start(),
                    params: &[$($(
                        $crate::methods::Param {
                            name: stringify!($field),
                            doc: concat!($($about),+).trim_ascii_start(),
                            kind: $crate::methods::choice!(@kind $type),
                            default: $crate::methods::choice!(@value $type $default),
                            ..$param
                        }
                    ),+)?],
                }),+
            ];

            fn all() -> &'static [$name] {
                &$name::ALL
            }

            fn place(&self) -> usize {
                enum Place {
                    $($variant),+
                }
                match self {
                    $($name::$variant { .. } => Place::$variant as usize,)+
                }
            }

            fn get(&self, param: &str) -> Option<$crate::methods::Value> {
                let _ = param;
                match self {
                    $($name::$variant { $($($field),+)? } => {
                        $($(
                            if param == stringify!($field) {
                                return Some($crate::methods::choice!(@value $type *$field));
                            }
                        )+)?
                        None
                    })+
                }
            }

            fn put(&mut self, param: &str, value: $crate::methods::Value) -> bool {
                let _ = (param, value);
                match self {
                    $($name::$variant { $($($field),+)? } => {
                        $($(
                            if param == stringify!($field) {
                                return $crate::methods::choice!(@put $type $field, value);
                            }
                        )+)?
                        false
                    })+
                }
            }
        }
    };
    (@word $name:literal) => { $name };
    (@word $name:literal, $word:literal) => { $word };
    (@kind f32) => { $crate::methods::Kind::Real };
    (@kind u32) => { $crate::methods::Kind::Whole };
    (@kind Limit) => { $crate::methods::Kind::Limit };
    (@kind $choice:ident) => {
        $crate::methods::Kind::Word(<$choice as $crate::methods::Choice>::METHODS)
    };
    (@value f32 $x:expr) => { $crate::methods::Value::Real($x) };
    (@value u32 $x:expr) => { $crate::methods::Value::Whole($x) };
    (@value Limit $x:expr) => { $crate::methods::Value::Limit($x) };
    (@value $choice:ident $x:expr) => { $crate::methods::Value::Word($x as usize) };
    (@put f32 $field:ident, $value:ident) => {
        if let $crate::methods::Value::Real(x) = $value { *$field = x; true } else { false }
    };
    (@put u32 $field:ident, $value:ident) => {
        if let $crate::methods::Value::Whole(n) = $value { *$field = n; true } else { false }
    };
    (@put Limit $field:ident, $value:ident) => {
        if let $crate::methods::Value::Limit(x) = $value { *$field = x; true } else { false }
    };
    (@put $choice:ident $field:ident, $value:ident) => {
        match $value {
            $crate::methods::Value::Word(i) if i < $choice::ALL.len() => { *$field = $choice::ALL[i]; true }
            _ => false,
        }
    };
}
pub(crate) use choice;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn sound<T: Choice>() {
        assert_eq!(T::METHODS.len(), T::all().len());
        assert_eq!(T::default(), T::all()[0]);
        for names in [
            |m: &Method| m.name,
            |m: &Method| m.word,
            |m: &Method| m.title,
        ] {
            let all: HashSet<_> = T::METHODS.iter().map(names).collect();
            assert_eq!(all.len(), T::METHODS.len(), "two have one name");
        }
        for (i, method) in T::METHODS.iter().enumerate() {
            let mut made = T::all()[i];
            assert_eq!(made.place(), i, "{}", method.name);
            assert_eq!(T::named(method.name), Some(made));
            assert_eq!(T::named(method.word), Some(made));
            assert!(!method.source.is_empty(), "{}", method.name);
            assert_line(method.doc);
            for param in method.params {
                assert_line(param.doc);
                assert_eq!(made.get(param.name), Some(param.default), "{}", param.name);
                assert_eq!(param.check(param.default), Ok(()), "{}", param.name);
                assert_eq!(made.set(param.name, param.default), Ok(()));
                let (low, high) = param.usual;
                let is_real = !matches!(param.kind, Kind::Word(_));
                assert!(!is_real || low < high, "{}", param.name);
                for x in [low, high] {
                    assert!(!is_real || param.value(x).is_ok(), "{} {x}", param.name);
                }
                assert!(!param.is_logarithmic || low > 0.0, "{}", param.name);
            }
            assert_eq!(made, T::all()[i], "what was set is what was there");
            assert_eq!(made.check(u64::MAX), Ok(()));
            assert!(made.get("nothing").is_none());
            assert!(made.set("nothing", Value::Real(1.0)).is_err());
        }
    }

    fn assert_line(doc: &str) {
        assert!(doc.ends_with('.') && doc.len() < 100, "{doc}");
        assert!(
            doc.starts_with(char::is_uppercase) || doc.starts_with(['(', '`', '|']),
            "{doc}"
        );
    }

    #[test]
    fn every_method_is_where_it_says() {
        sound::<March>();
        sound::<Normals>();
        sound::<Shadow>();
        sound::<Occlusion>();
        sound::<Shading>();
        sound::<Integrator>();
        sound::<Tone>();
        sound::<Antialias>();
        sound::<Filter>();
        sound::<Plane>();
    }

    /// No function of the scene language would be two methods, but for `none()`.
    #[test]
    fn words_are_unique_among_functions() {
        let mut seen = HashSet::new();
        for group in GROUPS.iter().filter(|g| g.is_called()) {
            for method in group.methods.iter().filter(|m| m.word != "none") {
                assert!(seen.insert(method.word), "{}", method.word);
            }
        }
        assert!(seen.len() > 12);
    }

    /// The ends of every range, and the numbers just beyond them.
    #[test]
    fn ranges_end_where_they_say() {
        for param in GROUPS.iter().flat_map(|g| g.methods).flat_map(|m| m.params) {
            let Allowed {
                min,
                max,
                is_above,
                is_below,
            } = param.allowed;
            if matches!(param.kind, Kind::Word(_)) {
                continue;
            }
            let whole = matches!(param.kind, Kind::Whole);
            let beyond = |x: f64, up: bool| match (whole, up) {
                (true, true) => x + 1.0,
                (true, false) => x - 1.0,
                (false, true) => f64::from((x as f32).next_up()),
                (false, false) => f64::from((x as f32).next_down()),
            };
            assert_eq!(param.value(min).is_ok(), !is_above, "{}", param.name);
            assert_eq!(param.value(max).is_ok(), !is_below, "{}", param.name);
            assert!(param.value(beyond(min, true)).is_ok(), "{}", param.name);
            assert!(param.value(beyond(max, false)).is_ok(), "{}", param.name);
            for x in [
                beyond(min, false),
                beyond(max, true),
                f64::NAN,
                f64::INFINITY,
            ] {
                let refused = param.value(x).expect_err(param.name).to_string();
                assert!(refused.contains(&param.allowed.to_string()), "{refused}");
            }
        }
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let mut march = March::named("relaxed").expect("a method");
        let said = |r: Result<(), Refused>| r.expect_err("refused").to_string();
        assert_eq!(
            said(march.set("omega", Value::Real(2.0))),
            "is 2, allowed is 1 to below 2"
        );
        assert_eq!(
            said(march.set("omega", Value::Whole(1))),
            "is of another kind"
        );
        let rays = &Occlusion::named("hemisphere")
            .expect("a method")
            .method()
            .params[0];
        let said = |r: Result<Value, Refused>| r.expect_err("refused").to_string();
        assert_eq!(said(rays.value(2.5)), "must be a whole number, not 2.5");
        assert_eq!(
            said(rays.within(64).value(65.0)),
            "is 65, allowed is 1 to 64"
        );
        assert_eq!(rays.within(8).default, Value::Whole(8));
        let reach = Occlusion::Cones {
            reach: Some(0.0),
            steps: 14,
        };
        let (param, refused) = reach.check(64).expect_err("refused");
        assert_eq!(
            (param, refused.to_string().as_str()),
            ("reach", "is 0, allowed is 1e-9 to 1e9")
        );
    }
}
