//! When values are known: while a scene is read, or at each point.

use super::translate::{Result, Root, Summary, Time, Times, Translator};
use naga::{Block, Expression as E, Function, Handle, Span, Statement as S, TypeInner};

impl<'m> Translator<'m> {
    /// What a function gives, for arguments of these kinds.
    fn summary(&mut self, handle: Handle<Function>, arguments: &[Time]) -> Result<Summary> {
        let key = (handle, arguments.to_vec());
        if let Some(summary) = self.summaries.get(&key) {
            return Ok(summary.clone());
        }
        let times = self.times(handle, arguments)?;
        let summary = Summary {
            result: times.result,
            after: times.arguments.clone(),
        };
        self.summaries.insert(key, summary.clone());
        Ok(summary)
    }

    pub(super) fn times(&mut self, handle: Handle<Function>, arguments: &[Time]) -> Result<Times> {
        let function = &self.module.functions[handle];
        if self.open.contains(&handle) {
            return self.refuse(
                Span::UNDEFINED,
                "a function that calls itself",
                "GLSL has no recursion either",
            );
        }
        self.learn(handle)?;
        self.open.push(handle);
        let mut times = Times {
            expressions: vec![Time::Unset; function.expressions.len()],
            variables: vec![Time::Unset; function.local_variables.len()],
            arguments: arguments.to_vec(),
            result: Time::Unset,
        };
        for (v, variable) in function.local_variables.iter() {
            if variable.init.is_some() {
                times.variables[v.index()] = Time::Plain;
            }
        }
        // what is known only grows
        for is_last in [false, true] {
            loop {
                let before = times.clone();
                self.expression_times(handle, function, &mut times);
                self.block_times(handle, function, &function.body, 0, &mut times)?;
                if before == times {
                    break;
                }
            }
            // what is never set as a whole is zero
            for time in times
                .variables
                .iter_mut()
                .filter(|t| !is_last && **t == Time::Unset)
            {
                *time = Time::Plain;
            }
        }
        self.open.pop();
        Ok(times)
    }

    fn expression_times(&self, handle: Handle<Function>, function: &Function, times: &mut Times) {
        let facts = &self.facts[&handle];
        for (h, expression) in function.expressions.iter() {
            let of = |h: &Handle<E>| times.expressions[h.index()];
            let is_aggregate = |h: Handle<E>| {
                !matches!(
                    facts.inner[h.index()],
                    TypeInner::Scalar(_) | TypeInner::Vector { .. }
                )
            };
            let time = match expression {
                E::Literal(_)
                | E::Constant(_)
                | E::ZeroValue(_)
                | E::Override(_)
                | E::GlobalVariable(_) => Time::Plain,
                E::FunctionArgument(k) => times.arguments[*k as usize],
                E::LocalVariable(v) => times.variables[v.index()],
                // known from the call
                E::CallResult(_) => of(&h),
                E::Compose { components, .. } if is_aggregate(h) => {
                    let all: Vec<Time> = components.iter().map(of).collect();
                    match all.contains(&Time::Unset) {
                        true => Time::Unset,
                        false => all.into_iter().fold(Time::Unset, Time::either),
                    }
                }
                E::Access { base, .. } => of(base),
                E::Binary { left, right, .. }
                    if is_aggregate(h) || is_aggregate(*left) || is_aggregate(*right) =>
                {
                    match (of(left), of(right)) {
                        (Time::Formula, _) if !is_aggregate(*left) || of(right) != Time::Mixed => {
                            Time::Formula
                        }
                        (_, Time::Formula) if !is_aggregate(*right) || of(left) != Time::Mixed => {
                            Time::Formula
                        }
                        (Time::Unset, _) | (_, Time::Unset) => Time::Unset,
                        (a, b) => a.either(b),
                    }
                }
                _ => {
                    let operands = self.operands(function, h);
                    let made = operands.iter().map(of).reduce(Time::with);
                    made.unwrap_or(Time::Plain)
                }
            };
            times.expressions[h.index()] = time;
        }
    }

    fn block_times(
        &mut self,
        handle: Handle<Function>,
        function: &Function,
        block: &Block,
        point: u32,
        times: &mut Times,
    ) -> Result<()> {
        for (statement, span) in block.span_iter() {
            match statement {
                S::Store { pointer, value } => {
                    let mut time = times.expressions[value.index()];
                    if point > 0 {
                        time = time.where_it_holds();
                    }
                    if let Some((root, steps)) = self.path(function, *pointer) {
                        let is_vector = matches!(
                            self.facts[&handle].inner[pointer.index()],
                            TypeInner::ValuePointer { size: None, .. }
                        );
                        Self::stored(times, root, !steps.is_empty(), is_vector, time);
                    }
                }
                S::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let by_point = u32::from(times.expressions[condition.index()] != Time::Plain);
                    self.block_times(handle, function, accept, point + by_point, times)?;
                    self.block_times(handle, function, reject, point + by_point, times)?;
                }
                S::Loop {
                    body, continuing, ..
                } => {
                    let by_point = u32::from(Self::leaves_by_point(body, times, 0));
                    self.block_times(handle, function, body, point + by_point, times)?;
                    // counting goes on whether or not a point has left the loop: that is the same for all points
                    self.block_times(handle, function, continuing, point, times)?;
                }
                S::Block(inner) => self.block_times(handle, function, inner, point, times)?,
                S::Return { value: Some(value) } => {
                    let mut time = times.expressions[value.index()];
                    if point > 0 || self.facts[&handle].returns > 1 {
                        time = time.where_it_holds();
                    }
                    times.result = times.result.either(time);
                }
                S::Call {
                    function: called,
                    arguments,
                    result,
                } => {
                    let given: Vec<Time> = arguments
                        .iter()
                        .map(|a| times.expressions[a.index()])
                        .collect();
                    // what is not known yet will be in a later round
                    if given.contains(&Time::Unset) {
                        continue;
                    }
                    let callee = &self.module.functions[*called];
                    let outs: Vec<bool> = callee
                        .arguments
                        .iter()
                        .map(|a| self.is_pointer(a.ty))
                        .collect();
                    let summary = self.summary(*called, &given).map_err(|e| e.or_at(*span))?;
                    if let Some(result) = result {
                        let time = times.expressions[result.index()];
                        times.expressions[result.index()] = time.either(summary.result);
                    }
                    for ((argument, out), mut time) in arguments.iter().zip(outs).zip(summary.after)
                    {
                        if out && let Some((root, steps)) = self.path(function, *argument) {
                            if point > 0 {
                                time = time.where_it_holds();
                            }
                            let is_vector = matches!(
                                self.facts[&handle].inner[argument.index()],
                                TypeInner::ValuePointer { size: None, .. }
                            );
                            Self::stored(times, root, !steps.is_empty(), is_vector, time);
                        }
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn stored(times: &mut Times, root: Root, is_part: bool, is_vector: bool, time: Time) {
        let slot = match root {
            Root::Local(v) => &mut times.variables[v.index()],
            Root::Argument(k) => &mut times.arguments[k as usize],
            Root::Global(_) => return,
        };
        let time = match (is_part, is_vector, *slot) {
            (false, ..) => time,
            // what it is as a whole comes later
            (true, _, Time::Unset) => return,
            (true, true, old) => old.with(time),
            (true, false, _) => time,
        };
        *slot = slot.either(time);
    }

    /// Whether a block leaves the loop that it is in where a condition of the point holds.
    fn leaves_by_point(block: &Block, times: &Times, point: u32) -> bool {
        block.iter().any(|statement| match statement {
            S::Break | S::Continue => point > 0,
            S::If {
                condition,
                accept,
                reject,
            } => {
                let point = point + u32::from(times.expressions[condition.index()] != Time::Plain);
                Self::leaves_by_point(accept, times, point)
                    || Self::leaves_by_point(reject, times, point)
            }
            S::Block(inner) => Self::leaves_by_point(inner, times, point),
            _ => false,
        })
    }
}
