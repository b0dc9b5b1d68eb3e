//! The text of an expression.

use super::store::{part, tuple};
use super::translate::{
    AND, ATOM, CHOICE, COMPARED, NOT, OR, PRODUCT, Result, SIGN, SUM, Text, Time, Translator,
    Writer, atom, bound, modulo, number, single,
};
use naga::{
    BinaryOperator as B, Expression as E, Function, Handle, Literal, MathFunction as M,
    RelationalFunction, ScalarKind, Span, SwizzleComponent, Type, TypeInner, UnaryOperator,
};

/// Characters of an expression from which on it is a line of its own.
const LONGEST: usize = 200;

/// Helpers that a scene gets where it needs them.
pub(super) const HELPERS: &[(&str, &str)] = &[
    (
        "apply_matrix",
        "# matrix * vector: a matrix is a tuple of its columns\ndef apply_matrix(m, v):\n    rows = [sum([m[k][row] * v[k] for k in range(len(m))]) for row in range(len(m[0]))]\n    return vector(*rows)\n",
    ),
    (
        "apply_transposed",
        "# vector * matrix\ndef apply_transposed(v, m):\n    return vector(*[sum([v[k] * column[k] for k in range(len(column))]) for column in m])\n",
    ),
    (
        "multiply_matrices",
        "# matrix * matrix\ndef multiply_matrices(a, b):\n    return [apply_matrix(a, column) for column in b]\n",
    ),
    (
        "transposed",
        "def transposed(m):\n    return [vector(*[column[k] for column in m]) for k in range(len(m[0]))]\n",
    ),
    (
        "remainder",
        "# of whole numbers, with the sign of the first one\ndef remainder(a, b):\n    return a - b * trunc(a / b)\n",
    ),
];

impl<'m> Translator<'m> {
    fn inner_of(&self, w: &Writer<'m>, h: Handle<E>) -> TypeInner {
        self.facts[&w.handle].inner[h.index()].clone()
    }

    /// How many parts a vector has; none for what is none.
    fn parts_of(&self, w: &Writer<'m>, h: Handle<E>) -> Option<usize> {
        match self.facts[&w.handle].inner[h.index()] {
            TypeInner::Vector { size, .. } => Some(size as usize),
            _ => None,
        }
    }

    fn kind(&self, w: &Writer<'m>, h: Handle<E>) -> Option<ScalarKind> {
        match self.facts[&w.handle].inner[h.index()] {
            TypeInner::Vector { scalar, .. } | TypeInner::Scalar(scalar) => Some(scalar.kind),
            _ => None,
        }
    }

    fn time(&self, w: &Writer<'m>, h: Handle<E>) -> Time {
        w.times.expressions[h.index()]
    }

    /// How a part of a vector is asked for: conditions are a tuple, whatever they depend on.
    fn part_time(&self, w: &Writer<'m>, h: Handle<E>) -> Time {
        if self.kind(w, h) == Some(ScalarKind::Bool) {
            Time::Mixed
        } else {
            self.time(w, h)
        }
    }

    /// Gives the value of an expression a name, on a line of its own.
    fn named(w: &mut Writer<'m>, h: Handle<E>, text: &Text) -> Text {
        let name = w.fresh("t");
        w.line(format!("{name} = {}", text.text));
        w.cache.insert(h, atom(name.clone()));
        w.pending.retain(|(p, _)| *p != h);
        atom(name)
    }

    /// The text of an expression that may be repeated.
    fn simple(&mut self, w: &mut Writer<'m>, h: Handle<E>) -> Result<Text> {
        let text = self.text(w, h)?;
        if text.is_simple() || matches!(w.function.expressions[h], E::Literal(_)) {
            return Ok(text);
        }
        Ok(Self::named(w, h, &text))
    }

    /// A vector as an operand: what is the same in all parts as a number.
    fn operand(&mut self, w: &mut Writer<'m>, h: Handle<E>) -> Result<Text> {
        match w.function.expressions[h] {
            E::Splat { value, .. } if !w.cache.contains_key(&h) => self.text(w, value),
            _ => self.text(w, h),
        }
    }

    /// What is done with each part of vectors. Plain numbers make no vector, so that they are taken one by one.
    fn by_parts(
        &mut self,
        w: &mut Writer<'m>,
        h: Handle<E>,
        operands: &[Handle<E>],
        write: &dyn Fn(&[Text]) -> Text,
    ) -> Result<Text> {
        let n = self.parts_of(w, h);
        let direct = n.is_none()
            || operands
                .iter()
                .any(|o| self.time(w, *o) == Time::Formula && self.is_real_vector(w, *o));
        if direct {
            let mut texts = Vec::new();
            for o in operands {
                texts.push(if n.is_some() {
                    self.operand(w, *o)?
                } else {
                    self.text(w, *o)?
                });
            }
            return Ok(write(&texts));
        }
        let n = n.unwrap_or(1);
        let mut columns = Vec::new();
        for o in operands {
            columns.push(self.columns(w, *o, n)?);
        }
        let parts: Vec<String> = (0..n)
            .map(|k| write(&columns.iter().map(|c| c[k].clone()).collect::<Vec<_>>()).text)
            .collect();
        Ok(self.vector(&parts, self.time(w, h)))
    }

    /// Whether an operand is written as a vector.
    fn is_real_vector(&self, w: &Writer<'m>, h: Handle<E>) -> bool {
        self.parts_of(w, h).is_some()
            && (w.cache.contains_key(&h) || !matches!(w.function.expressions[h], E::Splat { .. }))
    }

    fn vector(&self, parts: &[String], time: Time) -> Text {
        match time {
            Time::Plain => atom(tuple(parts)),
            _ => atom(format!("vec{}({})", parts.len(), parts.join(", "))),
        }
    }

    /// The parts of a vector, each as a text; of a number n times that.
    fn columns(&mut self, w: &mut Writer<'m>, h: Handle<E>, n: usize) -> Result<Vec<Text>> {
        if let E::Splat { value, .. } = w.function.expressions[h]
            && !w.cache.contains_key(&h)
        {
            let text = self.simple(w, value)?;
            return Ok(vec![text; n]);
        }
        if let E::Compose { components, .. } = &w.function.expressions[h]
            && components.len() == n
            && !w.cache.contains_key(&h)
        {
            let components = components.clone();
            return components.into_iter().map(|c| self.text(w, c)).collect();
        }
        let time = self.part_time(w, h);
        let is_vector = self.parts_of(w, h).is_some();
        let text = self.simple(w, h)?;
        Ok((0..n)
            .map(|k| {
                if is_vector {
                    atom(part(&text.text, k, time))
                } else {
                    text.clone()
                }
            })
            .collect())
    }

    /// An expression, as it is written.
    pub(super) fn text(&mut self, w: &mut Writer<'m>, h: Handle<E>) -> Result<Text> {
        if let Some(text) = w.cache.get(&h) {
            return Ok(text.clone());
        }
        let span = w.function.expressions.get_span(h);
        let text = self.expression(w, h).map_err(|e| e.or_at(span))?;
        let is_made = !matches!(
            w.function.expressions[h],
            E::Load { .. } | E::Compose { .. }
        );
        if text.text.len() < LONGEST
            || !is_made
            || self.kind(w, h).is_none_or(|k| k == ScalarKind::Bool)
        {
            return Ok(text);
        }
        // a line that nobody can read, and that nests deeper than a scene may
        Ok(Self::named(w, h, &text))
    }

    fn expression(&mut self, w: &mut Writer<'m>, h: Handle<E>) -> Result<Text> {
        let function: &'m Function = w.function;
        let span = function.expressions.get_span(h);
        if let Some((x, y)) = modulo(function, h) {
            return self.by_parts(w, h, &[x, y], &|t| {
                atom(format!("mod({}, {})", t[0].text, t[1].text))
            });
        }
        match &function.expressions[h] {
            E::Literal(literal) => self.literal(*literal, span),
            E::Constant(c) => Ok(atom(self.constant(*c)?)),
            E::ZeroValue(ty) => Ok(atom(self.zero(*ty))),
            E::Override(_) => self.refuse(
                span,
                "this is set from outside of the shader",
                "write a number",
            ),
            E::FunctionArgument(k) => Ok(atom(w.arguments[*k as usize].clone())),
            E::LocalVariable(_) | E::GlobalVariable(_) => self.pointed(w, h),
            E::Load { pointer } => self.pointed(w, *pointer),
            E::CallResult(_) => self.refuse(
                span,
                "what this call gives is not known",
                "write it in another way",
            ),
            E::Compose { ty, components } => {
                let is_vector = matches!(self.module.types[*ty].inner, TypeInner::Vector { .. });
                let is_array = matches!(self.module.types[*ty].inner, TypeInner::Array { .. });
                let mut texts = Vec::new();
                for c in components {
                    texts.push(self.text(w, *c)?.within(CHOICE + 1));
                }
                let scalars = components.iter().all(|c| self.parts_of(w, *c).is_none());
                Ok(match (is_vector, is_array) {
                    (true, _) if scalars => self.vector(&texts, self.time(w, h)),
                    (true, _) => {
                        let n = self.parts_of(w, h).unwrap_or(2);
                        atom(format!("vec{n}({})", texts.join(", ")))
                    }
                    (_, true) => atom(format!("[{}]", texts.join(", "))),
                    _ => atom(tuple(&texts)),
                })
            }
            E::Splat { size, value } => {
                let text = self.simple(w, *value)?;
                let n = *size as usize;
                Ok(match self.time(w, h) {
                    Time::Plain => atom(tuple(&vec![text.text; n])),
                    _ => atom(format!("vec{n}({})", text.text)),
                })
            }
            E::AccessIndex { base, index } => {
                if let E::Compose { components, .. } = &function.expressions[*base]
                    && !w.cache.contains_key(base)
                    && components.iter().all(|c| self.parts_of(w, *c).is_none())
                    && let Some(c) = components.get(*index as usize)
                {
                    return self.text(w, *c);
                }
                let text = self.text(w, *base)?.within(ATOM);
                let is_vector = self.parts_of(w, *base).is_some();
                let time = self.part_time(w, *base);
                Ok(atom(if is_vector {
                    part(&text, *index as usize, time)
                } else {
                    format!("{text}[{index}]")
                }))
            }
            E::Access { base, index } => {
                let at = self.index(w, *index)?;
                let text = self.text(w, *base)?.within(ATOM);
                Ok(atom(format!("{text}[{at}]")))
            }
            E::Swizzle {
                size,
                vector,
                pattern,
            } => {
                let n = *size as usize;
                let pattern: Vec<usize> = pattern[..n]
                    .iter()
                    .map(|c: &SwizzleComponent| *c as usize)
                    .collect();
                let time = self.time(w, *vector);
                if time == Time::Formula {
                    let text = self.text(w, *vector)?.within(ATOM);
                    let letters: String =
                        pattern.iter().map(|k| ["x", "y", "z", "w"][*k]).collect();
                    return Ok(atom(format!("{text}.{letters}")));
                }
                let text = self.simple(w, *vector)?;
                let parts: Vec<String> =
                    pattern.iter().map(|k| part(&text.text, *k, time)).collect();
                Ok(self.vector(&parts, time))
            }
            E::Unary { op, expr } => {
                let write: &dyn Fn(&[Text]) -> Text = match op {
                    UnaryOperator::Negate => &|t| bound(format!("-{}", t[0].within(SIGN)), SIGN),
                    UnaryOperator::LogicalNot => {
                        &|t| bound(format!("not {}", t[0].within(NOT)), NOT)
                    }
                    UnaryOperator::BitwiseNot => return self.bits(span),
                };
                self.by_parts(w, h, &[*expr], write)
            }
            E::Binary { op, left, right } => self.binary(w, h, *op, *left, *right),
            E::Select {
                condition,
                accept,
                reject,
            } => self.by_parts(w, h, &[*condition, *accept, *reject], &|t| {
                bound(
                    format!(
                        "({} if {} else {})",
                        t[1].within(OR),
                        t[0].within(OR),
                        t[2].within(OR)
                    ),
                    ATOM,
                )
            }),
            E::Relational { fun, argument } => {
                let n = self.parts_of(w, *argument).unwrap_or(1);
                let columns = self.columns(w, *argument, n)?;
                let (word, binds) = match fun {
                    RelationalFunction::All => (" and ", AND),
                    RelationalFunction::Any => (" or ", OR),
                    _ => {
                        return self.refuse(
                            span,
                            "whether a number is one cannot be asked",
                            "a formula has no such values",
                        );
                    }
                };
                let texts: Vec<String> = columns.iter().map(|c| c.within(NOT)).collect();
                Ok(bound(texts.join(word), binds))
            }
            E::Math {
                fun,
                arg,
                arg1,
                arg2,
                ..
            } => self.math(w, h, *fun, [Some(*arg), *arg1, *arg2]),
            E::As { expr, kind, .. } => {
                let from = self.kind(w, *expr);
                match (from, kind) {
                    (Some(ScalarKind::Bool), ScalarKind::Bool) => self.text(w, *expr),
                    (Some(ScalarKind::Bool), _) => self.by_parts(w, h, &[*expr], &|t| {
                        atom(format!("(1.0 if {} else 0.0)", t[0].within(OR)))
                    }),
                    (_, ScalarKind::Bool) => self.by_parts(w, h, &[*expr], &|t| {
                        bound(format!("{} != 0", t[0].within(SUM)), COMPARED)
                    }),
                    (Some(ScalarKind::Float), ScalarKind::Sint | ScalarKind::Uint)
                        if self.time(w, h) == Time::Plain =>
                    {
                        self.by_parts(w, h, &[*expr], &|t| atom(format!("int({})", t[0].text)))
                    }
                    (Some(ScalarKind::Float), ScalarKind::Sint | ScalarKind::Uint) => {
                        self.by_parts(w, h, &[*expr], &|t| atom(format!("trunc({})", t[0].text)))
                    }
                    _ => self.text(w, *expr),
                }
            }
            E::Derivative { .. } => self.refuse(
                span,
                "a derivative between pixels (dFdx, dFdy, fwidth) is no part of a distance",
                "leave it out: it belongs to shading",
            ),
            E::ImageSample { .. } | E::ImageLoad { .. } | E::ImageQuery { .. } => self.refuse(
                span,
                "textures are not translated",
                "replace it by noise(p), value_noise(p) or fbm(p), which scenes have",
            ),
            _ => self.refuse(
                span,
                "this expression is not translated",
                "a distance follows from arithmetic alone",
            ),
        }
    }

    fn bits<T>(&self, span: Span) -> Result<T> {
        self.refuse(
            span,
            "bits of whole numbers are not translated",
            "scenes have random(i), and noise(p), value_noise(p), cellular_noise(p) in formulas",
        )
    }

    fn literal(&self, literal: Literal, span: Span) -> Result<Text> {
        let signed = |text: String| {
            bound(
                text.clone(),
                if text.starts_with('-') { SIGN } else { ATOM },
            )
        };
        Ok(match literal {
            Literal::F64(x) | Literal::AbstractFloat(x) => signed(number(x)),
            Literal::F32(x) => signed(single(x)),
            Literal::U32(n) => atom(n.to_string()),
            Literal::I32(n) => signed(n.to_string()),
            Literal::U64(n) => atom(n.to_string()),
            Literal::I64(n) | Literal::AbstractInt(n) => signed(n.to_string()),
            Literal::Bool(true) => atom("True"),
            Literal::Bool(false) => atom("False"),
            _ => {
                return self.refuse(
                    span,
                    "a number of this kind is not translated",
                    "write a float",
                );
            }
        })
    }

    /// Zero of a type.
    pub(super) fn zero(&self, ty: Handle<Type>) -> String {
        match &self.module.types[ty].inner {
            TypeInner::Scalar(scalar) => match scalar.kind {
                ScalarKind::Bool => "False".into(),
                ScalarKind::Sint | ScalarKind::Uint => "0".into(),
                _ => "0.0".into(),
            },
            TypeInner::Vector { size, .. } => tuple(&vec!["0.0".into(); *size as usize]),
            TypeInner::Matrix { columns, rows, .. } => {
                tuple(&vec![
                    tuple(&vec!["0.0".into(); *rows as usize]);
                    *columns as usize
                ])
            }
            TypeInner::Array {
                base,
                size: naga::ArraySize::Constant(n),
                ..
            } => {
                format!("[{}]", vec![self.zero(*base); n.get() as usize].join(", "))
            }
            TypeInner::Struct { members, .. } => {
                tuple(&members.iter().map(|m| self.zero(m.ty)).collect::<Vec<_>>())
            }
            _ => "0.0".into(),
        }
    }

    /// What a variable or constant of the whole shader is at the beginning.
    fn initial(&mut self, h: Handle<E>) -> Result<String> {
        let span = self.module.global_expressions.get_span(h);
        match &self.module.global_expressions[h] {
            E::Literal(literal) => Ok(self.literal(*literal, span)?.text),
            E::Constant(c) => self.constant(*c),
            E::ZeroValue(ty) => Ok(self.zero(*ty)),
            E::Compose { ty, components } => {
                let is_vector = matches!(self.module.types[*ty].inner, TypeInner::Vector { .. });
                let mut texts = Vec::new();
                for c in components {
                    texts.push(self.initial(*c)?);
                }
                let is_array = matches!(self.module.types[*ty].inner, TypeInner::Array { .. });
                let n = match self.module.types[*ty].inner {
                    TypeInner::Vector { size, .. } => size as usize,
                    _ => texts.len(),
                };
                Ok(match () {
                    () if is_array => format!("[{}]", texts.join(", ")),
                    () if is_vector && n != texts.len() => format!("vec{n}({})", texts.join(", ")),
                    () => tuple(&texts),
                })
            }
            E::Splat { size, value } => {
                let text = self.initial(*value)?;
                Ok(tuple(&vec![text; *size as usize]))
            }
            _ => self.refuse(
                span,
                "this constant is not a number that can be told",
                "write it as a number, or in a function",
            ),
        }
    }

    fn constant(&mut self, c: Handle<naga::Constant>) -> Result<String> {
        if let Some(name) = self.global_constants.get(&c) {
            return Ok(name.clone());
        }
        let constant = &self.module.constants[c];
        let text = self.initial(constant.init)?;
        let Some(wanted) = &constant.name else {
            return Ok(text);
        };
        let name = Self::free(&mut self.taken, wanted);
        self.global_constants.insert(c, name.clone());
        let at = self.constants.len() as u32;
        self.constants.insert(at, (name.clone(), text));
        Ok(name)
    }

    /// The name of a variable of the whole shader.
    pub(super) fn global(&mut self, g: Handle<naga::GlobalVariable>) -> Result<String> {
        if let Some(name) = self.globals.get(&g) {
            return Ok(name.clone());
        }
        let variable = &self.module.global_variables[g];
        let wanted = variable.name.clone().unwrap_or_else(|| "value".into());
        let (text, note) = match (wanted.as_str(), variable.init) {
            ("iTime" | "iGlobalTime", None) => ("time()".to_owned(), None),
            ("iTimeDelta", None) => ("1 / 60".to_owned(), None),
            ("iFrameRate", None) => ("60.0".to_owned(), None),
            ("iFrame", None) => ("0".to_owned(), None),
            ("iResolution", None) => ("(512.0, 512.0, 1.0)".to_owned(), Some("a picture's size")),
            ("iMouse", None) => (self.zero(variable.ty), Some("where the mouse is")),
            (_, Some(init)) => (self.initial(init)?, None),
            (name, None) => {
                let note = if self.uniforms.iter().any(|u| u == name) {
                    "set from outside"
                } else {
                    "set elsewhere in the shader"
                };
                (self.zero(variable.ty), Some(note))
            }
        };
        if let Some(note) = note {
            self.notes.push(format!("`{wanted}` ({note}) is {text} here: write what it should be at the top of the scene"));
        }
        let name = Self::free(&mut self.taken, &wanted);
        self.globals.insert(g, name.clone());
        let at = self.constants.len() as u32;
        self.constants.insert(at, (name.clone(), text));
        Ok(name)
    }

    fn is_matrix(&self, w: &Writer<'m>, h: Handle<E>) -> bool {
        matches!(
            self.facts[&w.handle].inner[h.index()],
            TypeInner::Matrix { .. }
        )
    }

    fn helper(&mut self, name: &'static str, arguments: &[&Text]) -> Text {
        self.helpers.insert(name);
        if name == "multiply_matrices" {
            self.helpers.insert("apply_matrix");
        }
        let texts: Vec<&str> = arguments.iter().map(|a| a.text.as_str()).collect();
        atom(format!("{name}({})", texts.join(", ")))
    }

    fn binary(
        &mut self,
        w: &mut Writer<'m>,
        h: Handle<E>,
        op: B,
        left: Handle<E>,
        right: Handle<E>,
    ) -> Result<Text> {
        let span = w.function.expressions.get_span(h);
        let (is_left, is_right) = (self.is_matrix(w, left), self.is_matrix(w, right));
        if is_left || is_right {
            return self.of_matrices(w, op, left, right, span);
        }
        let is_bool = self.kind(w, left) == Some(ScalarKind::Bool);
        let is_whole = matches!(
            self.kind(w, left),
            Some(ScalarKind::Sint | ScalarKind::Uint)
        );
        let write: Operation = match op {
            B::Add => infix("+", SUM, SUM),
            B::Subtract => infix("-", SUM, PRODUCT),
            B::Multiply
                if self.kind(w, left) == Some(ScalarKind::Uint)
                    && self.time(w, h) != Time::Plain =>
            {
                return self.bits(span);
            }
            B::Multiply => infix("*", PRODUCT, PRODUCT),
            B::Divide if is_whole && self.time(w, h) == Time::Plain => Box::new(|t| {
                atom(format!(
                    "int({} / {})",
                    t[0].within(PRODUCT),
                    t[1].within(SIGN)
                ))
            }),
            B::Divide if is_whole => Box::new(|t| {
                atom(format!(
                    "trunc({} / {})",
                    t[0].within(PRODUCT),
                    t[1].within(SIGN)
                ))
            }),
            B::Divide => infix("/", PRODUCT, SIGN),
            B::Modulo => {
                self.helpers.insert("remainder");
                Box::new(|t| atom(format!("remainder({}, {})", t[0].text, t[1].text)))
            }
            B::Less => infix("<", COMPARED, COMPARED + 1),
            B::LessEqual => infix("<=", COMPARED, COMPARED + 1),
            B::Greater => infix(">", COMPARED, COMPARED + 1),
            B::GreaterEqual => infix(">=", COMPARED, COMPARED + 1),
            B::Equal if is_bool => Box::new(|t| {
                let (a, b) = (t[0].within(NOT), t[1].within(NOT));
                bound(format!("({a} and {b}) or not ({a} or {b})"), OR)
            }),
            B::NotEqual if is_bool => Box::new(|t| {
                let (a, b) = (t[0].within(NOT), t[1].within(NOT));
                bound(format!("({a} or {b}) and not ({a} and {b})"), AND)
            }),
            B::Equal => infix("==", COMPARED, COMPARED + 1),
            B::NotEqual => infix("!=", COMPARED, COMPARED + 1),
            B::LogicalAnd => infix("and", AND, AND),
            B::LogicalOr => infix("or", OR, OR),
            B::And if is_bool => infix("and", AND, AND),
            B::InclusiveOr if is_bool => infix("or", OR, OR),
            B::ExclusiveOr if is_bool => return self.binary(w, h, B::NotEqual, left, right),
            B::And | B::InclusiveOr | B::ExclusiveOr | B::ShiftLeft | B::ShiftRight
                if self.time(w, h) == Time::Plain =>
            {
                let sign = match op {
                    B::And => "&",
                    B::InclusiveOr => "|",
                    B::ExclusiveOr => "^",
                    B::ShiftLeft => "<<",
                    _ => ">>",
                };
                Box::new(move |t| {
                    atom(format!(
                        "({} {sign} {})",
                        t[0].within(SUM),
                        t[1].within(SUM)
                    ))
                })
            }
            _ => return self.bits(span),
        };
        let is_comparison = matches!(
            op,
            B::Less | B::LessEqual | B::Greater | B::GreaterEqual | B::Equal | B::NotEqual
        );
        if let (Some(n), true) = (self.parts_of(w, h), is_comparison || is_bool) {
            // conditions make no vector
            let (a, b) = (self.columns(w, left, n)?, self.columns(w, right, n)?);
            let parts: Vec<String> = (0..n)
                .map(|k| write(&[a[k].clone(), b[k].clone()]).within(CHOICE + 1))
                .collect();
            return Ok(atom(tuple(&parts)));
        }
        self.by_parts(w, h, &[left, right], &*write)
    }

    fn of_matrices(
        &mut self,
        w: &mut Writer<'m>,
        op: B,
        left: Handle<E>,
        right: Handle<E>,
        span: Span,
    ) -> Result<Text> {
        let (a, b) = (self.inner_of(w, left), self.inner_of(w, right));
        match (op, &a, &b) {
            (B::Multiply, TypeInner::Matrix { .. }, TypeInner::Vector { .. }) => {
                let (m, v) = (self.text(w, left)?, self.text(w, right)?);
                Ok(self.helper("apply_matrix", &[&m, &v]))
            }
            (B::Multiply, TypeInner::Vector { .. }, TypeInner::Matrix { .. }) => {
                let (v, m) = (self.text(w, left)?, self.text(w, right)?);
                Ok(self.helper("apply_transposed", &[&v, &m]))
            }
            (B::Multiply, TypeInner::Matrix { .. }, TypeInner::Matrix { .. }) => {
                let (a, b) = (self.text(w, left)?, self.text(w, right)?);
                Ok(self.helper("multiply_matrices", &[&a, &b]))
            }
            (B::Add | B::Subtract | B::Multiply | B::Divide, ..) => {
                let sign = match op {
                    B::Add => "+",
                    B::Subtract => "-",
                    B::Multiply => "*",
                    _ => "/",
                };
                let (columns, rows) = match (&a, &b) {
                    (TypeInner::Matrix { columns, rows, .. }, _)
                    | (_, TypeInner::Matrix { columns, rows, .. }) => {
                        (*columns as usize, *rows as usize)
                    }
                    _ => (2, 2),
                };
                let (x, y) = (self.simple(w, left)?.text, self.simple(w, right)?.text);
                let item = |is_matrix: bool, name: &str, i: usize, j: usize| {
                    if is_matrix {
                        format!("{name}[{i}][{j}]")
                    } else {
                        name.to_owned()
                    }
                };
                let (m, n) = (
                    matches!(a, TypeInner::Matrix { .. }),
                    matches!(b, TypeInner::Matrix { .. }),
                );
                let made: Vec<String> = (0..columns)
                    .map(|i| {
                        let of = |j| format!("{} {sign} {}", item(m, &x, i, j), item(n, &y, i, j));
                        tuple(&(0..rows).map(of).collect::<Vec<_>>())
                    })
                    .collect();
                Ok(atom(tuple(&made)))
            }
            _ => self.refuse(
                span,
                "this is not translated for matrices",
                "write it for their columns",
            ),
        }
    }

    fn math(
        &mut self,
        w: &mut Writer<'m>,
        h: Handle<E>,
        fun: M,
        arguments: [Option<Handle<E>>; 3],
    ) -> Result<Text> {
        let span = w.function.expressions.get_span(h);
        let given: Vec<Handle<E>> = arguments.into_iter().flatten().collect();
        let is_scalar = self.parts_of(w, given[0]).is_none();
        let name = match fun {
            M::Abs => "abs",
            M::Min => "min",
            M::Max => "max",
            M::Clamp => "clamp",
            M::Cos => "cos",
            M::Cosh => "cosh",
            M::Sin => "sin",
            M::Sinh => "sinh",
            M::Tan => "tan",
            M::Tanh => "tanh",
            M::Acos => "acos",
            M::Asin => "asin",
            M::Atan => "atan",
            M::Atan2 => "atan2",
            M::Radians => "radians",
            M::Degrees => "degrees",
            M::Ceil => "ceil",
            M::Floor => "floor",
            M::Round => "round",
            M::Fract => "fract",
            M::Trunc => "trunc",
            M::Exp => "exp",
            M::Exp2 => "exp2",
            M::Log => "log",
            M::Log2 => "log2",
            M::Pow => "pow",
            M::Sign => "sign",
            M::Mix => "mix",
            M::Step => "step",
            M::SmoothStep => "smoothstep",
            M::Sqrt => "sqrt",
            M::InverseSqrt => "inversesqrt",
            M::Saturate => {
                return self.by_parts(w, h, &given, &|t| {
                    atom(format!("clamp({}, 0.0, 1.0)", t[0].text))
                });
            }
            M::Fma => {
                return self.by_parts(w, h, &given, &|t| {
                    bound(
                        format!(
                            "{} * {} + {}",
                            t[0].within(PRODUCT),
                            t[1].within(PRODUCT),
                            t[2].within(SUM)
                        ),
                        SUM,
                    )
                });
            }
            // of numbers that are no vectors
            M::Length if is_scalar => "abs",
            M::Dot if is_scalar => {
                return self.by_parts(w, h, &given, &*infix("*", PRODUCT, PRODUCT));
            }
            M::Distance if is_scalar => {
                return self.by_parts(w, h, &given, &|t| {
                    atom(format!(
                        "abs({} - {})",
                        t[0].within(SUM),
                        t[1].within(PRODUCT)
                    ))
                });
            }
            M::Normalize if is_scalar => "sign",
            M::Dot | M::Cross | M::Distance | M::Length | M::Normalize | M::Reflect => {
                let name = match fun {
                    M::Dot => "dot",
                    M::Cross => "cross",
                    M::Distance => "distance",
                    M::Length => "length",
                    M::Normalize => "normalize",
                    _ => "reflect",
                };
                let mut texts = Vec::new();
                for g in &given {
                    texts.push(self.text(w, *g)?.text);
                }
                return Ok(atom(format!("{name}({})", texts.join(", "))));
            }
            M::Transpose => {
                let text = self.text(w, given[0])?;
                return Ok(self.helper("transposed", &[&text]));
            }
            other => {
                return self.refuse(
                    span,
                    format!("`{other:?}` is not translated").to_lowercase(),
                    "write what it does with other functions",
                );
            }
        };
        self.by_parts(w, h, &given, &|t| {
            let texts: Vec<&str> = t.iter().map(|t| t.text.as_str()).collect();
            atom(format!("{name}({})", texts.join(", ")))
        })
    }
}

/// What makes a text of those of its operands.
type Operation = Box<dyn Fn(&[Text]) -> Text>;

/// An operator between two texts: how it binds, and how its right side must.
fn infix(sign: &'static str, binds: u8, right: u8) -> Operation {
    let left = if binds == COMPARED {
        COMPARED + 1
    } else {
        binds
    };
    Box::new(move |t| {
        bound(
            format!("{} {sign} {}", t[0].within(left), t[1].within(right)),
            binds,
        )
    })
}
