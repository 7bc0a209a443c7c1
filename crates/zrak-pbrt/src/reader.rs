//! Tokens and parameter lists, of whichever file is open.

use zrak_scene::lower::Transform;
use zrak_scene::suggest;

use crate::error::{Fault, Result, Span};
use crate::lexer::{self, Kind};
use crate::params::{KINDS, Param, Params, Values};
use crate::state::Importer;

impl Importer {
    /// The next token, of whichever file is open.
    pub(crate) fn next(&mut self) -> Result<Option<(Kind, Span)>> {
        if let Some(token) = self.peeked.take() {
            return Ok(Some(token));
        }
        while let Some(open) = self.sources.open.last() {
            let (file, at) = (open.file, open.at);
            match lexer::next(self.sources.text(file), at, file)? {
                Some((kind, bytes)) => {
                    if let Some(open) = self.sources.open.last_mut() {
                        open.at = bytes.end;
                    }
                    return Ok(Some((kind, Span { file, bytes })));
                }
                None => self.leave_file()?,
            }
        }
        Ok(None)
    }

    /// The next token of a file, which stays open even if it has none.
    pub(crate) fn next_in(&mut self, file: usize) -> Result<Option<(Kind, Span)>> {
        if self.peeked.as_ref().is_some_and(|(_, span)| span.file == file) {
            return Ok(self.peeked.take());
        }
        let Some(open) = self.sources.open.last().filter(|open| open.file == file) else {
            return Ok(None);
        };
        let found = lexer::next(self.sources.text(file), open.at, file)?;
        Ok(found.map(|(kind, bytes)| {
            if let Some(open) = self.sources.open.last_mut() {
                open.at = bytes.end;
            }
            (kind, Span { file, bytes })
        }))
    }

    /// Goes back to the file that included the innermost one.
    fn leave_file(&mut self) -> Result<()> {
        let Some(open) = self.sources.open.pop() else { return Ok(()) };
        if !open.is_import {
            return Ok(());
        }
        let Some((state, n_scopes)) = self.imports.pop() else { return Ok(()) };
        if self.stack.len() != n_scopes {
            let end = open.at..open.at;
            let fault = Fault::new(
                &Span { file: open.file, bytes: end },
                "the imported file ends, but not all that it begins has an end",
            );
            return Err(
                fault.help("an imported file must be complete by itself; Include is not so strict")
            );
        }
        self.state = state;
        Ok(())
    }

    /// A token that must follow in the same file as `after`.
    pub(crate) fn expect(&mut self, after: &Span, what: &str) -> Result<(Kind, Span)> {
        self.next_in(after.file)?
            .ok_or_else(|| Fault::new(after, format!("{what} must follow here, but the file ends")))
    }

    pub(crate) fn text(&self, span: &Span) -> &str {
        &self.sources.text(span.file)[span.bytes.clone()]
    }

    pub(crate) fn string(&mut self, after: &Span, what: &str) -> Result<(String, Span)> {
        let (kind, span) = self.expect(after, what)?;
        if kind != Kind::String {
            return Err(Fault::new(&span, format!("{what} in quotes must stand here")));
        }
        Ok((lexer::unquote(self.text(&span)), span))
    }

    fn number(&mut self, after: &Span) -> Result<f64> {
        let (kind, span) = self.expect(after, "a number")?;
        match self.text(&span).parse::<f64>() {
            Ok(x) if kind == Kind::Word && x.is_finite() => Ok(x),
            _ => Err(Fault::new(&span, "a number must stand here")),
        }
    }

    /// Numbers, with brackets around them or without.
    pub(crate) fn numbers<const N: usize>(&mut self, after: &Span) -> Result<[f64; N]> {
        let token = self.expect(after, "a number")?;
        let bracketed = token.0 == Kind::Open;
        if !bracketed {
            self.peeked = Some(token);
        }
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.number(after)?;
        }
        if bracketed {
            let (kind, span) = self.expect(after, "a closing bracket")?;
            if kind != Kind::Close {
                return Err(Fault::new(&span, format!("there must be {N} numbers")));
            }
        }
        Ok(values)
    }

    /// The parameters that follow.
    pub(crate) fn params(&mut self, directive: &Span) -> Result<Params> {
        let mut params = Params { all: Vec::new(), span: directive.clone() };
        while let Some(token) = self.next_in(directive.file)? {
            if token.0 != Kind::String {
                self.peeked = Some(token);
                break;
            }
            let declared = lexer::unquote(self.text(&token.1));
            let words: Vec<&str> = declared.split_ascii_whitespace().collect();
            let [kind, name] = words[..] else {
                let fault = Fault::new(&token.1, "a parameter is \"type name\"");
                return Err(fault.help("such as \"float radius\", with one blank between the two"));
            };
            if !KINDS.contains(&kind) {
                let fault = Fault::new(&token.1, format!("unknown type `{kind}`"));
                return Err(match suggest::closest(kind, KINDS.iter().copied()) {
                    Some(near) => fault.help(format!("did you mean `{near}`?")),
                    None => fault.help(format!("the types are {}", KINDS.join(", "))),
                });
            }
            let values = self.values(kind, &token.1)?;
            let param = Param::new(kind.to_owned(), name.to_owned(), values, token.1);
            params.all.push(param);
        }
        Ok(params)
    }

    fn values(&mut self, kind: &str, after: &Span) -> Result<Values> {
        let first = self.expect(after, "a value")?;
        if first.0 != Kind::Open {
            let mut values = empty(kind, first.0 == Kind::String);
            self.value(&mut values, &first)?;
            return Ok(values);
        }
        let open = first.1;
        let mut token = self.next_in(open.file)?.ok_or_else(|| not_closed(&open))?;
        let mut values = empty(kind, token.0 == Kind::String);
        if let (Values::Numbers(all), Kind::Word) = (&mut values, token.0) {
            // Most of a large file is numbers: they are read without a token for each.
            let at = lexer::numbers(self.sources.text(open.file), token.1.bytes.start, all);
            if let Some(open) = self.sources.open.last_mut() {
                open.at = at;
            }
            token = self.next_in(open.file)?.ok_or_else(|| not_closed(&open))?;
        }
        while token.0 != Kind::Close {
            self.value(&mut values, &token)?;
            token = self.next_in(open.file)?.ok_or_else(|| not_closed(&open))?;
        }
        Ok(values)
    }

    fn value(&mut self, values: &mut Values, (kind, span): &(Kind, Span)) -> Result<()> {
        let text = self.text(span);
        match (values, kind) {
            (Values::Numbers(all), Kind::Word) => match text.parse::<f64>() {
                Ok(x) if x.is_finite() => {
                    all.push(x);
                    Ok(())
                }
                _ => Err(Fault::new(span, "this is not a number")),
            },
            (Values::Strings(all), Kind::String) => {
                all.push(lexer::unquote(text));
                Ok(())
            }
            (Values::Bools(all), Kind::Word | Kind::String) => {
                match lexer::unquote(text).as_str() {
                    "true" => all.push(true),
                    "false" => all.push(false),
                    _ => return Err(Fault::new(span, "this is neither true nor false")),
                }
                Ok(())
            }
            (Values::Numbers(_), _) => Err(Fault::new(span, "a number must stand here")),
            (Values::Strings(_), _) => Err(Fault::new(span, "a string in quotes must stand here")),
            (Values::Bools(_), _) => Err(Fault::new(span, "true or false must stand here")),
        }
    }

    /// The parameters that follow, and those that an `Attribute` gave for this kind of directive.
    pub(crate) fn params_of(&mut self, target: &str, directive: &Span) -> Result<Params> {
        let mut params = self.params(directive)?;
        if let Some(more) = self.state.attributes.get(target) {
            params.all.extend(more.iter().cloned());
        }
        Ok(params)
    }

    pub(crate) fn matrix(&mut self, span: &Span) -> Result<Transform> {
        // pbrt writes matrices by columns.
        let m: [f64; 16] = self.numbers(span)?;
        if [m[3], m[7], m[11]] != [0.0; 3] || m[15] == 0.0 {
            return Err(Fault::new(span, "maps that are not affine cannot be rendered"));
        }
        let rows = std::array::from_fn(|i| std::array::from_fn(|j| m[4 * j + i] / m[15]));
        Ok(Transform { rows })
    }
}

fn not_closed(open: &Span) -> Fault {
    Fault::new(open, "the bracket is not closed")
}

fn empty(kind: &str, quoted: bool) -> Values {
    match kind {
        "bool" => Values::Bools(Vec::new()),
        "string" | "texture" => Values::Strings(Vec::new()),
        "spectrum" if quoted => Values::Strings(Vec::new()),
        _ => Values::Numbers(Vec::new()),
    }
}
