//! Calls: of functions of the script, of this crate's, and of methods.

use super::depth::CALL;
use super::fields;
use super::formulas;
use super::machine::{Body, Machine, ParamKind};
use super::materials;
use super::methods;
use super::mistake::{Run, mistake};
use super::native::{Argument, Call, Native};
use super::run::Flow;
use super::synonyms;
use super::value::{DictKey, Method, Thing, Value};
use crate::report::{Place, listing, suggestion};
use starlark_syntax::codemap::Span;
use starlark_syntax::syntax::ast::{ArgumentP, AstArgument, AstExpr, ExprP};
use std::borrow::Cow;

impl<'a> Machine<'a> {
    pub(crate) fn call_expression(
        &mut self,
        function: &'a AstExpr,
        args: &'a [AstArgument],
        span: Span,
    ) -> Run<Value> {
        if let ExprP::Dot(object, name) = &function.node {
            let receiver = self.eval(object)?;
            // from the method's name on: the chain before it is not to blame
            let place = Place {
                end: span.end().get(),
                ..self.place(name.span)
            };
            let named = self.place(name.span);
            let method = self.method(receiver, &name.node);
            let (name, method) = method.map_err(|m| m.at(named))?;
            let arguments = self.arguments(args)?;
            return self
                .deeper(CALL, |m| {
                    m.call_method(receiver, name, method, arguments, place)
                })
                .map_err(|m| m.at(place));
        }
        let place = self.place(span);
        let callee = self.eval(function)?;
        let arguments = self.arguments(args)?;
        self.call(callee, arguments, place).map_err(|m| m.at(place))
    }

    fn arguments(&mut self, args: &'a [AstArgument]) -> Run<Vec<Argument<'a>>> {
        let mut out = Vec::with_capacity(args.len());
        for arg in args {
            let place = self.place(arg.span);
            match &arg.node {
                ArgumentP::Positional(e) => out.push(Argument {
                    name: None,
                    value: self.eval(e)?,
                    place,
                }),
                ArgumentP::Named(name, e) => {
                    let name = Some(Cow::Borrowed(name.node.as_str()));
                    out.push(Argument {
                        name,
                        value: self.eval(e)?,
                        place,
                    });
                }
                ArgumentP::Args(e) => {
                    let value = self.eval(e)?;
                    let items = self.collect(value).map_err(|m| m.at(place))?;
                    out.extend(items.into_iter().map(|value| Argument {
                        name: None,
                        value,
                        place,
                    }));
                }
                ArgumentP::KwArgs(e) => {
                    let value = self.eval(e)?;
                    let Value::Dict(dict) = value else {
                        let kind = self.store.kind(value);
                        return Err(mistake(format!("`**` needs a dict, not {kind}")).at(place));
                    };
                    let length = self.store.dict(dict).pairs.len();
                    self.grow_items(2 * length).map_err(|m| m.at(place))?;
                    for (key, (_, value)) in &self.store.dict(dict).pairs {
                        let DictKey::Text(name) = key else {
                            return Err(mistake("the keys after `**` must be texts").at(place));
                        };
                        out.push(Argument {
                            name: Some(Cow::Owned(name.to_string())),
                            value: *value,
                            place,
                        });
                    }
                }
            }
        }
        Ok(out)
    }

    /// Calls a value.
    pub(crate) fn call(
        &mut self,
        callee: Value,
        arguments: Vec<Argument<'a>>,
        place: Place,
    ) -> Run<Value> {
        self.deeper(CALL, |m| m.call_value(callee, arguments, place))
    }

    fn call_value(
        &mut self,
        callee: Value,
        arguments: Vec<Argument<'a>>,
        place: Place,
    ) -> Run<Value> {
        match callee {
            Value::Function(i) => self.call_function(i, arguments, place),
            Value::Native(native) => match self.formula_function(native.name, &arguments) {
                Some(function) => self.call_formula(function, &arguments, place),
                None => self.call_native(native, Value::None, arguments, place),
            },
            Value::Formula(function) => self.call_formula(function, &arguments, place),
            Value::Thing(i)
                if matches!(self.store.thing(i), Thing::Field(_) | Thing::Registers(_)) =>
            {
                match self.store.thing(i).clone() {
                    Thing::Field(field) => self.ask_field(&field, &arguments, place),
                    Thing::Registers(list) => self.ask_registers(&list, &arguments, place),
                    _ => Ok(Value::None),
                }
            }
            Value::Primitive(entry) => {
                if let Some(function) = self.formula_function(entry.info.name, &arguments) {
                    return self.call_formula(function, &arguments, place);
                }
                let params = entry.info.params.iter().map(|p| p.name).collect();
                let mut call = Call::bind(
                    self,
                    entry.info.name,
                    params,
                    false,
                    Value::None,
                    arguments,
                    place,
                )?;
                fields::primitive(&mut call, entry)
            }
            Value::Join(entry) => {
                if let Some(function) = self.formula_function(entry.info.name, &arguments) {
                    return self.call_formula(function, &arguments, place);
                }
                let arguments = self.gather_fields(arguments)?;
                let params = std::iter::once("shapes")
                    .chain(entry.info.params.iter().map(|p| p.name))
                    .collect();
                let mut call = Call::bind(
                    self,
                    entry.info.name,
                    params,
                    false,
                    Value::None,
                    arguments,
                    place,
                )?;
                fields::join(&mut call, entry)
            }
            Value::Bound(i) => {
                let (receiver, name, method) = self.store.bound[i as usize];
                self.call_method(receiver, name, method, arguments, place)
            }
            other => {
                let kind = self.store.kind(other);
                Err(mistake(format!(
                    "{kind} is not a function and cannot be called"
                )))
            }
        }
    }

    /// `union(a, b, c)` is `union([a, b, c])`.
    fn gather_fields(&mut self, mut arguments: Vec<Argument<'a>>) -> Run<Vec<Argument<'a>>> {
        let is_field = |a: &Argument<'a>| {
            let field = |i| matches!(self.store.thing(i), Thing::Field(_));
            a.name.is_none() && matches!(a.value, Value::Thing(i) if field(i))
        };
        let count = arguments.iter().take_while(|a| is_field(a)).count();
        let Some(first) = arguments.first().filter(|_| count > 0) else {
            return Ok(arguments);
        };
        let last = &arguments[count - 1];
        let place = Place {
            end: last.place.end,
            ..first.place
        };
        self.grow_items(count)?;
        let items = arguments.drain(..count).map(|a| a.value).collect();
        let value = self.list(items)?;
        arguments.insert(
            0,
            Argument {
                name: None,
                value,
                place,
            },
        );
        Ok(arguments)
    }

    /// `dict(pairs, a = 1)` as `dict(pairs + [("a", 1)])`.
    fn with_named_pairs(&mut self, arguments: Vec<Argument<'a>>) -> Run<Vec<Argument<'a>>> {
        let Some(place) = arguments.iter().find(|a| a.name.is_some()).map(|a| a.place) else {
            return Ok(arguments);
        };
        let dict = self.dict()?;
        let (mut rest, mut named) = (Vec::new(), Vec::new());
        for argument in arguments {
            match argument.name {
                Some(name) => named.push((name, argument.value)),
                None => rest.push(argument),
            }
        }
        if let [one] = &rest[..] {
            let pairs = match one.value {
                Value::Dict(other) => self.store.dict(other).pairs.values().copied().collect(),
                other => {
                    let mut pairs = Vec::new();
                    for pair in self.collect(other).map_err(|m| m.at(one.place))? {
                        match self.store.items(pair) {
                            Some(&[key, value]) => pairs.push((key, value)),
                            _ => {
                                let m = mistake("dict() needs pairs such as (\"key\", 1)");
                                return Err(m.at(one.place));
                            }
                        }
                    }
                    pairs
                }
            };
            pairs
                .into_iter()
                .try_for_each(|(k, v)| self.insert(dict, k, v))?;
            rest.clear();
        }
        for (name, value) in named {
            let key = self.text(name.as_ref())?;
            self.insert(dict, key, value)?;
        }
        rest.insert(
            0,
            Argument {
                name: None,
                value: Value::Dict(dict),
                place,
            },
        );
        Ok(rest)
    }

    fn call_native(
        &mut self,
        native: &'static Native,
        receiver: Value,
        arguments: Vec<Argument<'a>>,
        place: Place,
    ) -> Run<Value> {
        let (params, arguments) = match native.name {
            // dict(a = 1): the names are keys
            "dict" => (vec!["pairs"], self.with_named_pairs(arguments)?),
            _ => (native.params.iter().map(|p| p.name).collect(), arguments),
        };
        let mut call = Call::bind(
            self,
            native.name,
            params,
            native.rest,
            receiver,
            arguments,
            place,
        )?;
        (native.run)(&mut call)
    }

    fn call_method(
        &mut self,
        receiver: Value,
        name: &'static str,
        method: Method,
        arguments: Vec<Argument<'a>>,
        place: Place,
    ) -> Run<Value> {
        let catalogue = |info: &'static zeroset_catalogue::Info| info.params.iter().map(|p| p.name);
        match method {
            Method::Modify(entry)
                if entry.info.name == formulas::DISPLACE.name && gives_function(&arguments) =>
            {
                self.call_native(&formulas::DISPLACE, receiver, arguments, place)
            }
            Method::Native(native) => self.call_native(native, receiver, arguments, place),
            Method::Map(entry) => {
                let params = catalogue(&entry.info).collect();
                let mut call = Call::bind(self, name, params, false, receiver, arguments, place)?;
                fields::map(&mut call, entry)
            }
            Method::Modify(entry) => {
                let params = catalogue(&entry.info).collect();
                let mut call = Call::bind(self, name, params, false, receiver, arguments, place)?;
                fields::modify(&mut call, entry)
            }
            Method::Join(entry) => {
                let params = std::iter::once("other")
                    .chain(catalogue(&entry.info))
                    .collect();
                let mut call = Call::bind(self, name, params, false, receiver, arguments, place)?;
                fields::join_method(&mut call, entry)
            }
        }
    }

    /// The method of this name.
    fn method(&self, receiver: Value, name: &str) -> Run<(&'static str, Method)> {
        let natives: &'static [Native] = match receiver {
            Value::Text(_) => methods::TEXT,
            Value::List(_) => methods::LIST,
            Value::Dict(_) => methods::DICT,
            Value::Thing(i) if matches!(self.store.thing(i), Thing::Pattern(_)) => {
                materials::METHODS
            }
            Value::Thing(i) if matches!(self.store.thing(i), Thing::Field(_)) => {
                return fields::method(name).ok_or_else(|| {
                    let functions = fields::function_of_this_name(name);
                    let help = functions
                        .or_else(|| synonyms::of_name(name))
                        .or_else(|| suggestion(name, fields::method_names().iter().copied()));
                    mistake(format!("a field has no method `{name}`")).maybe_help(help)
                });
            }
            _ => &[],
        };
        natives
            .iter()
            .find(|n| n.name == name)
            .map(|n| (n.name, Method::Native(n)))
            .ok_or_else(|| {
                let names: Vec<&str> = natives.iter().map(|n| n.name).collect();
                let help = suggestion(name, names.iter().copied()).or_else(|| {
                    (!names.is_empty()).then(|| format!("there are {}", listing(&names)))
                });
                mistake(format!(
                    "{} has no method `{name}`",
                    self.store.kind(receiver)
                ))
                .maybe_help(help)
            })
    }

    /// `object.name` without a call.
    pub(crate) fn attribute(&mut self, object: Value, name: &str) -> Run<Value> {
        if let Some(part) = self.part_of_formula(object, name) {
            return part;
        }
        let (name, method) = self.method(object, name)?;
        self.bound(object, name, method)
    }

    fn call_function(
        &mut self,
        number: u32,
        arguments: Vec<Argument<'a>>,
        place: Place,
    ) -> Run<Value> {
        if self.calls >= self.limits.calls {
            let message = format!("more than {} calls inside each other", self.limits.calls);
            return Err(
                mistake(message).help("end the recursion earlier, or raise the limit `calls`")
            );
        }
        let values = self.bind_function(number, arguments)?;
        let f = &self.functions[number as usize];
        let (names, body, module, parent) = (f.locals.clone(), f.body, f.module, f.frame);
        let outer = std::mem::replace(&mut self.module, module);
        let (from, branches) = (self.pending.len(), std::mem::take(&mut self.branches));
        self.calls += 1;
        let result = self.in_frame(names, values, parent, |m| match body {
            Body::Expression(e) => m.eval(e),
            Body::Block(block) => {
                let last = match m.statement(block)? {
                    Flow::Return(value) => value,
                    _ => Value::None,
                };
                m.returned(from, last)
            }
        });
        self.branches = branches;
        self.calls -= 1;
        self.module = outer;
        result.map_err(|m| m.called_from(place))
    }

    /// The variables of a call, parameters filled in.
    fn bind_function(
        &mut self,
        number: u32,
        arguments: Vec<Argument<'a>>,
    ) -> Run<Vec<Option<Value>>> {
        let count = self.functions[number as usize].locals.len();
        self.charge(count as u64)?;
        let mut values: Vec<Option<Value>> = vec![None; count];
        let (mut rest, mut rest_named) = (Vec::new(), Vec::new());
        // by name, each is compared with every parameter
        let params = self.functions[number as usize].params.len() as u64;
        let named = arguments.iter().filter(|a| a.name.is_some()).count() as u64;
        self.charge(named.saturating_mul(1 + params / 16))?;
        // parameters stand in front of the other variables, in the same order
        let f = &self.functions[number as usize];
        let name = f.name;
        let mut places = f
            .params
            .iter()
            .enumerate()
            .filter(|(_, p)| p.kind == ParamKind::Normal)
            .map(|(i, _)| i);
        let takes = |kind| f.params.iter().position(|p| p.kind == kind);
        let (takes_rest, takes_named) = (takes(ParamKind::Rest), takes(ParamKind::RestNamed));
        for argument in arguments {
            let index = match &argument.name {
                None => match places.next() {
                    Some(i) => i,
                    None if takes_rest.is_some() => {
                        rest.push(argument.value);
                        continue;
                    }
                    None => {
                        let message = format!(
                            "{name}() takes at most {} values by place",
                            f.normal_params()
                        );
                        return Err(mistake(message).at(argument.place));
                    }
                },
                Some(written) => {
                    let fits = |kind| kind == ParamKind::Normal || kind == ParamKind::Named;
                    match f
                        .params
                        .iter()
                        .position(|p| p.name == written && fits(p.kind))
                    {
                        Some(i) => i,
                        None if takes_named.is_some() => {
                            rest_named.push((written.to_string(), argument.value));
                            continue;
                        }
                        None => {
                            let names = f.params.iter().filter(|p| fits(p.kind)).map(|p| p.name);
                            let help = suggestion(written, names);
                            let message = format!("{name}() has no argument `{written}`");
                            return Err(mistake(message).maybe_help(help).at(argument.place));
                        }
                    }
                }
            };
            if values[index].is_some() {
                let message = format!("{name}() is given `{}` twice", f.params[index].name);
                return Err(mistake(message).at(argument.place));
            }
            values[index] = Some(argument.value);
        }
        for (param, value) in f.params.iter().zip(&mut values) {
            if value.is_none() {
                *value = param.default;
            }
            if value.is_none() && matches!(param.kind, ParamKind::Normal | ParamKind::Named) {
                return Err(mistake(format!("{name}() needs `{}`", param.name)));
            }
        }
        if let Some(i) = takes_rest {
            self.grow_items(rest.len())?;
            values[i] = Some(self.tuple(rest)?);
        }
        if let Some(i) = takes_named {
            let dict = self.dict()?;
            for (name, value) in rest_named {
                let key = self.text(name)?;
                self.insert(dict, key, value)?;
            }
            values[i] = Some(Value::Dict(dict));
        }
        Ok(values)
    }
}

/// Whether the first thing given is a function.
fn gives_function(arguments: &[Argument<'_>]) -> bool {
    let first = arguments.first().map(|a| a.value);
    matches!(
        first,
        Some(Value::Function(_) | Value::Native(_) | Value::Formula(_))
    )
}

impl super::machine::Function<'_> {
    fn normal_params(&self) -> usize {
        self.params
            .iter()
            .filter(|p| p.kind == ParamKind::Normal)
            .count()
    }
}
