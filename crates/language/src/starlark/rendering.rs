//! How the scene is rendered: `render(...)` and the methods that it takes, which are those of the registry.

use super::mistake::{Run, mistake};
use super::native::{Call, Native, Slot, slot};
use super::value::{Thing, Value};
use crate::draft::check_size;
use crate::report::suggestion;
use std::sync::LazyLock;
use zeroset_scene::methods::{self, Choice, Group, Kind, Param};
use zeroset_scene::settings::{
    Antialias, Integrator, March, Normals, Occlusion, Settings, Shading, Shadow, Tone,
};

/// The functions.
pub(crate) fn all() -> &'static [Native] {
    static ALL: LazyLock<Vec<Native>> = LazyLock::new(|| {
        let mut all = vec![
            Native {
                name: "render",
                doc: "How the picture is made.",
                group: "Rendering",
                params: slots(),
                rest: false,
                run: render,
            },
            Native {
                name: "none",
                doc: "Without: shadow, ambient occlusion, antialiasing.",
                group: "Rendering",
                params: &[],
                rest: false,
                run: |c| c.machine.thing(Thing::Nothing),
            },
        ];
        functions::<March>(&mut all, |c| make(c, Thing::March));
        functions::<Shadow>(&mut all, |c| make(c, Thing::Shadow));
        functions::<Occlusion>(&mut all, |c| make(c, Thing::Occlusion));
        functions::<Antialias>(&mut all, |c| make(c, Thing::Antialias));
        functions::<Integrator>(&mut all, |c| make(c, Thing::Integrator));
        all
    });
    &ALL
}

/// A function for each method but `none`, which is one for all.
fn functions<T: Choice>(all: &mut Vec<Native>, run: fn(&mut Call<'_, '_>) -> Run<Value>) {
    let methods = T::METHODS.iter().filter(|m| m.word != NONE);
    all.extend(methods.map(|method| Native {
        name: method.word,
        doc: method.doc,
        group: T::TITLE,
        params: kept(method.params.iter().map(slot_of).collect()),
        rest: false,
        run,
    }));
}

/// The method of every kind that does nothing.
const NONE: &str = "none";

fn slot_of(param: &Param) -> Slot {
    slot(param.name, param.written(param.default).leak(), param.doc)
}

/// For as long as the process: the functions of the language are made once.
fn kept(slots: Vec<Slot>) -> &'static [Slot] {
    slots.leak()
}

/// What `render()` takes.
fn slots() -> &'static [Slot] {
    let choice = |group: Group, doc: &str| {
        let as_written = |m: &methods::Method| match group.is_called() {
            true => format!("{}()", m.word),
            false => format!("\"{}\"", m.name),
        };
        let words: Vec<String> = group.methods.iter().map(as_written).collect();
        let default = words[0].clone().leak();
        let doc = format!("{doc}: {}.", words.join(", ")).leak();
        slot(group.key, default, doc)
    };
    let number = |param: Param| {
        let doc = param.doc.trim_end_matches('.');
        let doc = format!("{doc}, {}.", param.allowed).leak();
        Slot {
            doc,
            ..slot_of(&param)
        }
    };
    kept(vec![
        slot("size", "(512, 512)", "Width and height in pixels."),
        choice(Group::of::<March>(), "How rays find the surface"),
        choice(Group::of::<Normals>(), "How normals are found"),
        choice(Group::of::<Occlusion>(), "Ambient occlusion"),
        choice(Group::of::<Antialias>(), "Antialiasing"),
        choice(Group::of::<Shading>(), "How light becomes colour"),
        choice(
            Group::of::<Integrator>(),
            "Which ways light takes to the eye",
        ),
        number(Settings::EXPOSURE),
        choice(Group::of::<Tone>(), "How light beyond white is shown"),
        slot(
            "seed",
            "0",
            "Chooses other random numbers for everything that samples.",
        ),
        slot(
            "prepass",
            "True",
            "Whether whole tiles are marched as cones first.",
        ),
        number(Settings::MAX_STEPS),
        slot(
            "hit_selection",
            "True",
            "Whether a ray that runs out of steps takes its best candidate.",
        ),
        number(Settings::DISCONTINUITY_REDUCTION),
        number(Settings::FOOTPRINT),
    ])
}

/// The method whose name the call has, with the numbers that are given.
fn make<T: Choice>(c: &mut Call<'_, '_>, thing: fn(T) -> Thing) -> Run<Value> {
    let mut made = T::named(c.name).unwrap_or_default();
    for param in made.method().params {
        let value = c.value(&param.within(c.machine.limits.samples))?;
        (made.set(param.name, value))
            .map_err(|refused| mistake(format!("{} {refused}", c.called(param.name))))?;
    }
    c.machine.thing(thing(made))
}

impl Call<'_, '_> {
    /// A parameter of a method, or its default.
    fn value(&self, param: &Param) -> Run<methods::Value> {
        let Some(given) = self.get(param.name) else {
            return Ok(param.default);
        };
        if let Kind::Word(methods) = param.kind {
            let text = self.text(param.name, given)?;
            return param.word(&text).ok_or_else(|| {
                let names = methods.iter().map(|m| m.name);
                mistake(format!("{} cannot be \"{text}\"", self.called(param.name)))
                    .maybe_help(suggestion(&text, names))
                    .at(given.place)
            });
        }
        let x = self.number(param.name, given)?;
        param.value(x).map_err(|refused| {
            mistake(format!("{} {refused}", self.called(param.name))).at(given.place)
        })
    }

    /// A number of the settings, or what it is where nothing is said.
    fn real(&self, param: Param) -> Run<f32> {
        match self.value(&param)? {
            methods::Value::Real(x) => Ok(x),
            other => unreachable!("{other:?} is no number"),
        }
    }

    /// A whole number of the settings, or what it is where nothing is said.
    fn whole(&self, param: Param) -> Run<u32> {
        match self.value(&param)? {
            methods::Value::Whole(n) => Ok(n),
            other => unreachable!("{other:?} is no whole number"),
        }
    }

    /// A method that is written as a word, or the default.
    fn worded<T: Choice>(&self) -> Run<T> {
        let words: Vec<_> = (T::METHODS.iter().map(|m| m.name))
            .zip(T::all().iter().copied())
            .collect();
        self.word_or(T::KEY, T::default(), &words)
    }

    /// A method that is made by a function: `pick` takes it out of what was given; the default where nothing was.
    pub(crate) fn method<T: Choice>(&self, pick: fn(&Thing) -> Option<T>) -> Run<T> {
        let Some(given) = self.get(T::KEY) else {
            return Ok(T::default());
        };
        let found = match given.value {
            Value::Thing(i) => match self.machine.store.thing(i) {
                Thing::Nothing => T::named(NONE),
                thing => pick(thing),
            },
            _ => None,
        };
        found.ok_or_else(|| {
            let first = T::METHODS[0].word;
            self.unfit(T::KEY, &format!("{} such as {first}()", T::WHAT), given)
        })
    }
}

fn render(c: &mut Call<'_, '_>) -> Run<Value> {
    c.once("how it is rendered")?;
    let d = Settings::default();
    let size = match c.get("size") {
        None => d.size,
        Some(given) => {
            let numbers: [f64; 2] = c.numbers("size", given)?;
            if numbers
                .iter()
                .any(|x| x.fract() != 0.0 || !(1.0..=1e6).contains(x))
            {
                let m = mistake(format!(
                    "{} must be two whole numbers from 1 to 1,000,000",
                    c.called("size")
                ));
                return Err(m.at(given.place));
            }
            let size = numbers.map(|x| x as u32);
            check_size(size, &c.machine.limits).map_err(|m| mistake(m).at(given.place))?;
            size
        }
    };
    let settings = Settings {
        size,
        march: c.method(Thing::march)?,
        prepass: c.flag_or("prepass", d.prepass)?,
        max_steps: c.whole(Settings::MAX_STEPS)?,
        hit_selection: c.flag_or("hit_selection", d.hit_selection)?,
        discontinuity_reduction: c.whole(Settings::DISCONTINUITY_REDUCTION)?,
        footprint: c.real(Settings::FOOTPRINT)?,
        normals: c.worded()?,
        shading: c.worded()?,
        integrator: c.method(Thing::integrator)?,
        occlusion: c.method(Thing::occlusion)?,
        antialias: c.method(Thing::antialias)?,
        seed: c.count_or("seed", d.seed, 0, u32::MAX)?,
        exposure: c.real(Settings::EXPOSURE)?,
        tone: c.worded()?,
    };
    c.machine.draft.settings = Some(settings);
    Ok(Value::None)
}
