//! Values in Starlark: which calls say them, and where their arguments stand.

use super::plan::{self, Given, Literal, Statement};
use super::{Change, Edits, Look, Reason};
use crate::document::on_a_deep_stack;
use crate::limits::Limits;
use crate::load::{Control, Failed, Loaded, Parameter, Setting};
use crate::report::Source;
use crate::starlark::module::parse;
use crate::starlark::{assigned_names, parameters_of};
use glam::Vec3;
use starlark_syntax::codemap::Span;
use starlark_syntax::syntax::ast::{
    ArgumentP, AstArgument, AstExpr, AstLiteral, AstStmt, ExprP, StmtP,
};
use starlark_syntax::syntax::uniplate::Visit;
use std::ops::Range;
use zeroset_scene::light::{Light, Source as LightSource};

/// Functions whose calls say values that can be changed from outside.
const FUNCTIONS: [&str; 9] = [
    "slider", "choice", "toggle", "color", "camera", "sun", "sky", "show", "material",
];

/// A call of one of them.
#[derive(Clone, Copy)]
struct Found<'a> {
    function: &'static str,
    args: &'a [AstArgument],
    span: Span,
    /// Whether it stands in a function or a loop.
    is_repeated: bool,
}

/// All of a file.
struct Calls<'a> {
    source: &'a Source,
    all: Vec<Found<'a>>,
    /// What the file gives a name once, at its top, and nowhere else.
    constants: Vec<(&'a str, &'a AstExpr)>,
    /// Names that the file gives a meaning of its own.
    own: Vec<&'a str>,
}

/// As [`super::revise`].
pub(super) fn revise(
    name: &str,
    text: &str,
    loaded: &Loaded,
    changes: &[Change],
    edits: &mut Edits<'_>,
    record: &mut (dyn FnMut(&Change, Result<(), Reason>) + Send),
) -> Result<(), Failed> {
    // the parser and all passes over its tree call themselves
    on_a_deep_stack(|| {
        let source = Source::new(name, text);
        let (tree, _) = parse(0, name, text, &Limits::default()).map_err(|m| Failed {
            report: m.report(std::slice::from_ref(&source)).into(),
            files: Vec::new(),
        })?;
        let calls = Calls::of(&source, &tree);
        for change in changes {
            let mark = edits.mark();
            let result = calls.revise(loaded, change, edits);
            if result.is_err() {
                edits.back_to(mark);
            }
            record(change, result);
        }
        Ok(())
    })?
}

impl<'a> Calls<'a> {
    fn of(source: &'a Source, tree: &'a AstStmt) -> Calls<'a> {
        let own = assigned_names(tree);
        let mut calls = Calls {
            source,
            all: Vec::new(),
            constants: Vec::new(),
            own: own.iter().map(|(name, _)| *name).collect(),
        };
        calls.statement(tree, false);
        // a name with one meaning
        let once = |name: &str| own.iter().any(|(n, count)| *n == name && *count == 1);
        calls.constants.retain(|(name, _)| once(name));
        calls
    }

    fn statement(&mut self, statement: &'a AstStmt, is_repeated: bool) {
        let within = is_repeated || matches!(statement.node, StmtP::For(_) | StmtP::Def(_));
        if let (StmtP::Assign(assign), false) = (&statement.node, is_repeated)
            && let starlark_syntax::syntax::ast::AssignTargetP::Identifier(ident) = &assign.lhs.node
        {
            self.constants.push((&ident.node.ident, &assign.rhs));
        }
        statement.visit_children(|child| match child {
            Visit::Stmt(s) => self.statement(s, within),
            Visit::Expr(e) => self.expression(e, within),
        });
    }

    fn expression(&mut self, expression: &'a AstExpr, is_repeated: bool) {
        let within = is_repeated
            || matches!(
                expression.node,
                ExprP::Lambda(_) | ExprP::ListComprehension(..) | ExprP::DictComprehension(..)
            );
        if let Some(found) = found(expression, within) {
            self.all.push(found);
        }
        expression.visit_expr(|e| self.expression(e, within));
    }

    fn line(&self, span: Span) -> usize {
        self.source.position(span.begin().get() as usize).0
    }

    /// The calls of a function, unless the file gives its name another meaning.
    fn of_function(&self, function: &'static str) -> Vec<Found<'a>> {
        if self.own.contains(&function) {
            return Vec::new();
        }
        let all = self.all.iter().filter(|f| f.function == function);
        all.copied().collect()
    }

    /// The call at a place of this file.
    fn at(
        &self,
        function: &'static str,
        place: Option<&(String, u32, u32)>,
    ) -> Result<Found<'a>, Reason> {
        let (file, line, column) = place.ok_or(Reason::NotFound(function))?;
        if *file != self.source.name {
            return Err(Reason::OtherFile(file.clone()));
        }
        let here = |f: &Found<'_>| {
            let at = self.source.position(f.span.begin().get() as usize);
            at == (*line as usize, *column as usize)
        };
        let mut all = self.of_function(function).into_iter();
        all.find(here).ok_or(Reason::NotFound(function))
    }

    /// The one call of a function, outside of loops and functions; `None` where there is none.
    fn one(&self, function: &'static str) -> Result<Option<Found<'a>>, Reason> {
        let all = self.of_function(function);
        match all[..] {
            [] => Ok(None),
            [one] if one.is_repeated => Err(Reason::Repeated {
                function,
                line: self.line(one.span),
            }),
            [one] => Ok(Some(one)),
            [first, ..] => Err(Reason::Many {
                function,
                count: all.len(),
                line: self.line(first.span),
            }),
        }
    }

    fn revise(
        &self,
        loaded: &Loaded,
        change: &Change,
        edits: &mut Edits<'_>,
    ) -> Result<(), Reason> {
        let scene = &loaded.scene;
        match change {
            Change::Parameter { name, setting } => {
                let parameter = loaded.parameters.iter().find(|p| p.name == *name);
                self.parameter(parameter.ok_or(Reason::NotFound("slider"))?, setting, edits)
            }
            Change::Camera { camera, target } => match self.one("camera")? {
                Some(call) => {
                    let mut call = self.edited(call, edits)?;
                    plan::camera(&mut call, scene.camera(), camera, *target)
                }
                None => {
                    let mut added = Added::new("camera");
                    // all of it is to be said but what follows from the bounds
                    let nowhere = zeroset_scene::camera::Camera {
                        eye: Vec3::INFINITY,
                        lens: scene.camera().lens,
                        ..*scene.camera()
                    };
                    plan::camera(&mut added, &nowhere, camera, *target)?;
                    added.append(edits);
                    Ok(())
                }
            },
            Change::Sun {
                light,
                direction,
                radiance,
            } => self.sun(scene.lights(), *light, *direction, *radiance, edits),
            Change::Sky {
                top,
                horizon,
                bottom,
                ambient,
            } => {
                let before = scene.sky();
                let colours = [("top", *top), ("horizon", *horizon), ("bottom", *bottom)];
                let said = |to: &mut dyn FnMut(&str, Literal) -> Result<(), Reason>| {
                    if [before.top, before.horizon, before.bottom] != [*top, *horizon, *bottom] {
                        for (name, colour) in colours {
                            to(name, Literal::of_linear(colour))?;
                        }
                    }
                    if before.ambient != *ambient {
                        to("ambient", Literal::single(*ambient))?;
                    }
                    Ok(())
                };
                match self.one("sky")? {
                    Some(call) => {
                        let mut call = self.edited(call, edits)?;
                        let mut is_one = !matches!(call.given("color"), Given::Absent);
                        said(&mut |name, value| match name {
                            "top" if std::mem::take(&mut is_one) => {
                                call.exchange("color", name, value)
                            }
                            _ => call.set(name, value),
                        })
                    }
                    None => {
                        let mut added = Added::new("sky");
                        said(&mut |name, value| added.set(name, value))?;
                        added.append(edits);
                        Ok(())
                    }
                }
            }
            Change::Material { material, look } => {
                let has = |o: &&zeroset_scene::scene::Object| usize::from(o.material) == *material;
                for object in scene.objects().iter().filter(has) {
                    let show = self.at("show", object.place.as_ref())?;
                    self.material(show, look, edits)?;
                }
                Ok(())
            }
        }
    }

    fn parameter(
        &self,
        parameter: &Parameter,
        setting: &Setting,
        edits: &mut Edits<'_>,
    ) -> Result<(), Reason> {
        let function = match parameter.control {
            Control::Slider { .. } => "slider",
            Control::Choice { .. } => "choice",
            Control::Toggle => "toggle",
            Control::Colour => "color",
        };
        let value = |setting: &Setting| match setting {
            Setting::Number(x) => Literal::Number(*x + 0.0),
            Setting::Text(text) => Literal::Text(text.clone()),
            Setting::Flag(on) => Literal::Flag(*on),
            Setting::Colour(srgb) => Literal::colour(*srgb),
        };
        let first = self.at(function, parameter.place.as_ref())?;
        let mut call = self.edited(first, edits)?;
        if !matches!(call.given("name"), Given::Literal(Literal::Text(_))) {
            let (what, line) = ("its name".to_owned(), self.line(first.span));
            return Err(Reason::Expression { what, line });
        }
        call.set("default", value(setting))?;
        // a parameter may be asked for more than once; then all must agree
        let before = value(&parameter.default);
        for other in self.of_function(function) {
            if other.span == first.span {
                continue;
            }
            let mut call = self.edited(other, edits)?;
            let is_same = matches!(call.given("name"), Given::Literal(Literal::Text(n)) if n == parameter.name);
            let agrees = match call.given("default") {
                Given::Literal(default) => default.means(&before),
                Given::Absent => true,
                Given::Expression => false,
            };
            if is_same && agrees {
                call.set("default", value(setting))?;
            }
        }
        Ok(())
    }

    fn sun(
        &self,
        lights: &[Light],
        light: usize,
        direction: Vec3,
        radiance: Vec3,
        edits: &mut Edits<'_>,
    ) -> Result<(), Reason> {
        let is_sun = |l: &&Light| matches!(l.source, LightSource::Directional { .. });
        let suns = lights.iter().filter(is_sun).count();
        let which = lights.iter().take(light).filter(is_sun).count();
        let before = lights.get(light).ok_or(Reason::NotFound("sun"))?;
        let calls = self.of_function("sun");
        let repeated = calls.iter().find(|c| c.is_repeated);
        if let Some(call) = repeated {
            let (function, line) = ("sun", self.line(call.span));
            return Err(Reason::Repeated { function, line });
        }
        let mut said = Vec::new();
        if !matches!(before.source, LightSource::Directional { direction: d } if d == direction) {
            said.push(("direction", Literal::vector(direction)));
        }
        if before.radiance != radiance || calls.is_empty() {
            let strength = radiance.max_element();
            // black has no colour of its own
            let colour = if strength > 0.0 {
                radiance / strength
            } else {
                Vec3::ONE
            };
            said.push(("color", Literal::of_linear(colour)));
            said.push(("strength", Literal::single(strength)));
        }
        if calls.is_empty() && lights.len() == 1 {
            // the light of a scene that states none
            let mut added = Added::new("sun");
            let way = ("direction", Literal::vector(direction));
            if said.iter().all(|(name, _)| *name != "direction") {
                said.insert(0, way);
            }
            for (name, value) in said {
                added.set(name, value)?;
            }
            if let zeroset_scene::settings::Shadow::SoftClosest { sharpness } = before.shadow {
                added.text += &format!(", shadow = soft_closest(sharpness = {sharpness})");
            }
            added.append(edits);
            return Ok(());
        }
        let Some(call) = calls.get(which).filter(|_| calls.len() == suns) else {
            return Err(Reason::NotFound("sun"));
        };
        let mut call = self.edited(*call, edits)?;
        for (name, value) in said {
            call.set(name, value)?;
        }
        Ok(())
    }

    /// Makes what `show` gives its object say a look.
    fn material(&self, show: Found<'a>, look: &Look, edits: &mut Edits<'_>) -> Result<(), Reason> {
        let said = [
            ("color", look.colour.map(Literal::colour)),
            ("roughness", look.roughness.map(Literal::single)),
            ("metallic", look.metallic.map(Literal::single)),
            ("specular", look.specular.map(Literal::single)),
        ];
        let said = said
            .into_iter()
            .filter_map(|(name, value)| Some((name, value?)));
        let call = self.edited(show, edits)?;
        let given = call.argument("material").map(|(_, e)| e);
        // a name that stands for one thing
        let made = given.map(|e| match &e.node {
            ExprP::Identifier(ident) => {
                let named = self.constants.iter().find(|(n, _)| *n == ident.node.ident);
                named.map_or(e, |(_, e)| *e)
            }
            _ => e,
        });
        if let Some(made) = made
            && let Some(found) = found(made, false).filter(|f| f.function == "material")
            && !self.own.contains(&"material")
        {
            let mut call = self.edited(found, edits)?;
            let is_shiny = !matches!(call.given("shininess"), Given::Absent);
            for (name, value) in said {
                if let ("roughness", true, Some(r)) = (name, is_shiny, look.roughness) {
                    let shininess = crate::starlark::shininess_of(r);
                    call.set("shininess", Literal::single(shininess))?;
                }
                call.set(name, value)?;
            }
            return Ok(());
        }
        // a colour, or nothing, becomes a material
        let (colour, span) = match made {
            None => (None, None),
            Some(made) => match (literal(made), whole(edits.text, made)) {
                (Some(literal), Some(span)) => (Some(literal), Some(span)),
                _ => {
                    return Err(Reason::Expression {
                        what: "`material` of show()".into(),
                        line: self.line(made.span),
                    });
                }
            },
        };
        let mut text = Added::new("material");
        if let (Some(colour), None) = (colour, look.colour) {
            text.set("color", colour)?;
        }
        for (name, value) in said {
            text.set(name, value)?;
        }
        let text = text.text + ")";
        match span {
            Some(span) => edits.replace(span, text),
            None => self.edited(show, edits)?.add("material", &text),
        }
        Ok(())
    }

    /// A call that can be changed.
    fn edited<'e, 't>(
        &'e self,
        call: Found<'a>,
        edits: &'e mut Edits<'t>,
    ) -> Result<Edited<'e, 'a, 't>, Reason> {
        let spread = |a: &AstArgument| matches!(a.node, ArgumentP::Args(_) | ArgumentP::KwArgs(_));
        if call.args.iter().any(spread) {
            return Err(Reason::Spread {
                function: call.function,
                line: self.line(call.span),
            });
        }
        Ok(Edited {
            calls: self,
            call,
            edits,
        })
    }
}

/// A call of one of the functions that say values.
fn found(expression: &AstExpr, is_repeated: bool) -> Option<Found<'_>> {
    let ExprP::Call(function, args) = &expression.node else {
        return None;
    };
    let ExprP::Identifier(ident) = &function.node else {
        return None;
    };
    let function = FUNCTIONS.into_iter().find(|f| *f == ident.node.ident)?;
    Some(Found {
        function,
        args: &args.args,
        span: expression.span,
        is_repeated,
    })
}

/// The value that an expression writes out.
fn literal(expression: &AstExpr) -> Option<Literal> {
    Some(match &expression.node {
        ExprP::Literal(AstLiteral::String(text)) => Literal::Text(text.node.clone()),
        ExprP::Identifier(ident) => match ident.node.ident.as_str() {
            "True" => Literal::Flag(true),
            "False" => Literal::Flag(false),
            "None" => Literal::None,
            _ => return None,
        },
        ExprP::Tuple(items) | ExprP::List(items) => {
            Literal::Numbers(items.iter().map(number).collect::<Option<_>>()?)
        }
        ExprP::Call(function, args) => {
            let is_lens =
                matches!(&function.node, ExprP::Identifier(i) if i.node.ident == "orthographic");
            match &args.args[..] {
                [one] if is_lens => Literal::Orthographic(number(value(one))?),
                _ => return None,
            }
        }
        _ => Literal::Number(number(expression)?),
    })
}

/// The number that an expression writes out.
fn number(expression: &AstExpr) -> Option<f64> {
    match &expression.node {
        ExprP::Literal(AstLiteral::Int(int)) => int.node.to_string().parse().ok(),
        ExprP::Literal(AstLiteral::Float(x)) => Some(x.node),
        ExprP::Minus(e) => number(e).map(|x| -x),
        ExprP::Plus(e) => number(e),
        _ => None,
    }
}

fn value(argument: &AstArgument) -> &AstExpr {
    match &argument.node {
        ArgumentP::Positional(e)
        | ArgumentP::Named(_, e)
        | ArgumentP::Args(e)
        | ArgumentP::KwArgs(e) => e,
    }
}

fn bytes(span: Span) -> Range<usize> {
    span.begin().get() as usize..span.end().get() as usize
}

/// A call whose arguments are changed.
struct Edited<'e, 'a, 't> {
    calls: &'e Calls<'a>,
    call: Found<'a>,
    edits: &'e mut Edits<'t>,
}

impl<'a> Edited<'_, 'a, '_> {
    /// An argument by the name of its parameter, and its value.
    fn argument(&self, name: &str) -> Option<(&'a AstArgument, &'a AstExpr)> {
        let params = parameters_of(self.call.function);
        let at = params.iter().position(|p| *p == name);
        let args = self.call.args.iter().enumerate();
        let mut hits = args.filter(|(i, a)| match &a.node {
            ArgumentP::Named(n, _) => n.node == name,
            _ => Some(*i) == at,
        });
        hits.next().map(|(_, a)| (a, value(a)))
    }

    fn is_literal(&self, name: &str, e: &AstExpr) -> Result<Literal, Reason> {
        literal(e).ok_or_else(|| self.expression(name, e))
    }

    fn expression(&self, name: &str, e: &AstExpr) -> Reason {
        Reason::Expression {
            what: format!("`{name}` of {}()", self.call.function),
            line: self.calls.line(e.span),
        }
    }

    fn add(&mut self, name: &str, text: &str) {
        match self.call.args.last() {
            Some(last) => {
                let at = bytes(last.span).end;
                self.edits.insert(at, format!(", {name} = {text}"));
            }
            None => {
                let at = bytes(self.call.span).end - 1;
                // after one that was added before
                let is_first = !self.edits.all.iter().any(|(span, _)| *span == (at..at));
                let comma = if is_first { "" } else { ", " };
                self.edits.insert(at, format!("{comma}{name} = {text}"));
            }
        }
    }
}

impl Statement for Edited<'_, '_, '_> {
    fn given(&self, name: &str) -> Given {
        match self.argument(name) {
            None => Given::Absent,
            Some((_, e)) => literal(e).map_or(Given::Expression, Given::Literal),
        }
    }

    fn set(&mut self, name: &str, value: Literal) -> Result<(), Reason> {
        let Some((_, e)) = self.argument(name) else {
            self.add(name, &written(&value, '"'));
            return Ok(());
        };
        if self.is_literal(name, e)?.means(&value) {
            return Ok(());
        }
        let text = self.edits.text;
        let is_single = text[bytes(e.span)].starts_with('\'');
        let quote = if is_single { '\'' } else { '"' };
        match (whole(text, e), value) {
            (Some(span), value) => self.edits.replace(span, written(&value, quote)),
            // a comment stands between a bracket and the numbers
            (None, Literal::Numbers(all)) => self.edits.replace(bytes(e.span), list(&all)),
            (None, _) => return Err(self.expression(name, e)),
        }
        Ok(())
    }

    fn exchange(&mut self, old: &str, new: &str, value: Literal) -> Result<(), Reason> {
        let Some((argument, e)) = self.argument(old) else {
            return self.set(new, value);
        };
        self.is_literal(old, e)?;
        let text = format!("{new} = {}", written(&value, '"'));
        self.edits.replace(bytes(argument.span), text);
        Ok(())
    }

    fn has_height(&self) -> bool {
        false
    }
}

/// A statement that the file does not have yet.
struct Added {
    text: String,
    is_empty: bool,
}

impl Added {
    fn new(function: &str) -> Added {
        Added {
            text: format!("{function}("),
            is_empty: true,
        }
    }

    /// Puts it at the end of the file, on a line of its own.
    fn append(self, edits: &mut Edits<'_>) {
        let text = edits.text;
        let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
        let begin = if text.is_empty() || text.ends_with('\n') {
            ""
        } else {
            end
        };
        edits.insert(text.len(), format!("{begin}{}){end}", self.text));
    }
}

impl Statement for Added {
    fn given(&self, _: &str) -> Given {
        Given::Absent
    }

    fn set(&mut self, name: &str, value: Literal) -> Result<(), Reason> {
        let comma = if std::mem::take(&mut self.is_empty) {
            ""
        } else {
            ", "
        };
        self.text += &format!("{comma}{name} = {}", written(&value, '"'));
        Ok(())
    }

    fn exchange(&mut self, _: &str, new: &str, value: Literal) -> Result<(), Reason> {
        self.set(new, value)
    }

    fn has_height(&self) -> bool {
        false
    }
}

/// A literal as the language writes it.
fn written(value: &Literal, quote: char) -> String {
    match value {
        Literal::None => "None".into(),
        Literal::Flag(true) => "True".into(),
        Literal::Flag(false) => "False".into(),
        Literal::Number(x) => digits(*x),
        Literal::Text(text) => quoted(text, quote),
        Literal::Numbers(all) => format!("({})", list(all)),
        Literal::Orthographic(height) => format!("orthographic({})", digits(*height)),
    }
}

fn list(all: &[f64]) -> String {
    let all: Vec<String> = all.iter().map(|x| digits(*x)).collect();
    all.join(", ")
}

/// The bytes of a value with the brackets of a tuple, which its span leaves out. `None` where more than blanks stands between.
fn whole(text: &str, expression: &AstExpr) -> Option<Range<usize>> {
    let span = bytes(expression.span);
    if !matches!(expression.node, ExprP::Tuple(_)) {
        return Some(span);
    }
    let before = text[..span.start].trim_end();
    let after = &text[span.end..];
    let rest = after.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
    let is_whole = before.ends_with('(') && rest.starts_with(')');
    is_whole.then(|| before.len() - 1..text.len() - rest.len() + 1)
}

/// A number in the fewest digits that mean it.
fn digits(x: f64) -> String {
    let x = x + 0.0;
    if x == 0.0 || (1e-5..1e15).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:?}")
    }
}

fn quoted(text: &str, quote: char) -> String {
    let mut out = String::from(quote);
    for c in text.chars() {
        match c {
            '\n' => out += "\\n",
            '\r' => out += "\\r",
            '\t' => out += "\\t",
            '\\' => out += "\\\\",
            c if c == quote => {
                out.push('\\');
                out.push(c);
            }
            c if c.is_control() => out += &format!("\\U{:08x}", u32::from(c)),
            c => out.push(c),
        }
    }
    out.push(quote);
    out
}
