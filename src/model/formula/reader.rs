//! The grammar of formulas: from text to operations, by recursive descent of bounded depth.
//!
//! ```text
//! sum     = product { (+ | -) product }
//! product = sign { (* | /) sign }
//! sign    = - sign | + sign | power
//! power   = atom [ ^ integer ]
//! atom    = number | name | function ( sum { , sum } ) | ( sum )
//! ```

use super::error::{Fault, InvalidFormula};
use super::fold::{self, Constants};
use super::name::{self, Elementary, check_names, printable, shortened, stumpff_order};
use super::token::{self, Token};
use super::{Entry, Formulas, Operation};
use crate::model::nearest::nearest;
use crate::number::Rational;
use num_traits::ToPrimitive;

/// The longest text of one formula, in bytes.
pub const LONGEST_TEXT: usize = 10_000;

/// The most operations of all formulas and definitions together.
pub const MOST_OPERATIONS: usize = 20_000;

/// The deepest nesting of parentheses, calls and signs.
pub const DEEPEST: usize = 100;

/// The largest exponent, in size.
pub const LARGEST_EXPONENT: i64 = 64;

/// How many characters of the text an error shows on either side of the place.
const SHOWN: usize = 20;

/// A fault, and the byte at which it is.
type Found = (usize, Fault);

/// Reads definitions and formulas, each a name and a text.
pub(super) fn read(
    names: &[&str],
    definitions: &[(&str, &str)],
    formulas: &[(&str, &str)],
) -> Result<Formulas, InvalidFormula> {
    check_names(names.iter().copied().chain(definitions.iter().map(|(name, _)| *name)))?;
    let mut building = Building {
        names,
        definitions,
        defined: Vec::new(),
        operations: Vec::new(),
        constants: Vec::new(),
    };
    for (name, text) in definitions {
        let result = building.formula(name, text)?;
        building.defined.push(result);
    }
    let entry = |(name, result): (&str, usize)| Entry {
        name: name.to_owned(),
        result,
    };
    let mut read = Vec::with_capacity(formulas.len());
    for (name, text) in formulas {
        read.push(entry((name, building.formula(name, text)?)));
    }
    let names_of_definitions = definitions.iter().map(|(name, _)| *name);
    Ok(Formulas {
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        definitions: names_of_definitions.zip(building.defined).map(entry).collect(),
        results: read,
        operations: building.operations,
    })
}

/// What has been read so far.
struct Building<'a> {
    names: &'a [&'a str],
    definitions: &'a [(&'a str, &'a str)],
    /// The results of the definitions that have been read.
    defined: Vec<usize>,
    operations: Vec<Operation>,
    constants: Constants,
}

impl Building<'_> {
    /// Reads one text: the place of its result.
    fn formula(&mut self, name: &str, text: &str) -> Result<usize, InvalidFormula> {
        self.text(text).map_err(|(byte, fault)| InvalidFormula::Text {
            of: shortened(name),
            column: column(text, byte),
            near: around(text, byte),
            fault,
        })
    }

    fn text(&mut self, text: &str) -> Result<usize, Found> {
        if text.len() > LONGEST_TEXT {
            return Err((0, Fault::TooLong));
        }
        let mut reader = Reader {
            building: self,
            text,
            token: Token::End,
            start: 0,
            end: 0,
            depth: 0,
        };
        reader.advance()?;
        if reader.token == Token::End {
            return Err((0, Fault::Empty));
        }
        let result = reader.sum()?;
        match reader.token {
            Token::End => Ok(result),
            Token::Sign(')') => reader.fail(Fault::Unopened),
            Token::Sign(',') => reader.fail(Fault::Comma),
            token => reader.fail(Fault::MissingOperator(token.to_string())),
        }
    }

    /// Adds an operation, which stands at a byte of the text: its place in the list.
    fn push(&mut self, operation: Operation, byte: usize) -> Result<usize, Found> {
        if self.operations.len() >= MOST_OPERATIONS {
            return Err((byte, Fault::TooMany));
        }
        let constant = fold::constant(&operation, &self.constants, &self.defined).map_err(|fault| (byte, fault))?;
        self.operations.push(operation);
        self.constants.push(constant);
        Ok(self.operations.len() - 1)
    }

    /// What a word stands for that is not called.
    fn word(&self, word: &str) -> Result<Operation, Fault> {
        if let Some(index) = self.names.iter().position(|name| *name == word) {
            return Ok(Operation::Name(index));
        }
        if let Some(index) = self.definitions.iter().position(|(name, _)| *name == word) {
            return match index.cmp(&self.defined.len()) {
                std::cmp::Ordering::Less => Ok(Operation::Definition(index)),
                std::cmp::Ordering::Equal => Err(Fault::Itself(word.to_owned())),
                std::cmp::Ordering::Greater => Err(Fault::Later(word.to_owned())),
            };
        }
        if word == name::PI {
            return Ok(Operation::Call(Elementary::Pi, Vec::new()));
        }
        if Elementary::named(word).is_some() {
            return Err(Fault::NotCalled(word.to_owned()));
        }
        let defined = self.definitions.iter().take(self.defined.len()).map(|(name, _)| *name);
        let known = self.names.iter().copied().chain(defined).chain([name::PI]);
        Err(Fault::UnknownName {
            name: shortened(word),
            nearest: nearest(word, known),
        })
    }

    /// The function that a word before a parenthesis names.
    fn function(&self, word: &str) -> Result<Elementary, Fault> {
        let is_number = |name: &&str| *name == word;
        if self.names.iter().any(is_number)
            || self.definitions.iter().any(|(name, _)| is_number(name))
            || word == name::PI
        {
            return Err(Fault::NotAFunction(word.to_owned()));
        }
        if let Some(function) = Elementary::named(word) {
            return Ok(function);
        }
        if stumpff_order(word).is_some() {
            return Err(Fault::Order(shortened(word)));
        }
        let functions = name::functions();
        let other = match word {
            "log" => Some("ln".to_owned()),
            "arctan2" | "arctan" | "atan" => Some("atan2".to_owned()),
            _ => nearest(word, functions.iter().map(String::as_str)),
        };
        Err(Fault::UnknownFunction {
            name: shortened(word),
            nearest: other,
        })
    }
}

/// The reader of one text, one piece ahead.
struct Reader<'r, 'a, 't> {
    building: &'r mut Building<'a>,
    text: &'t str,
    token: Token<'t>,
    /// The bytes of the piece.
    start: usize,
    end: usize,
    depth: usize,
}

impl Reader<'_, '_, '_> {
    fn advance(&mut self) -> Result<(), Found> {
        (self.token, self.start, self.end) = token::next(self.text, self.end)?;
        Ok(())
    }

    /// A fault at the piece.
    fn fail<R>(&self, fault: Fault) -> Result<R, Found> {
        Err((self.start, fault))
    }

    /// Runs a part one level deeper.
    fn deeper(&mut self, part: fn(&mut Self) -> Result<usize, Found>) -> Result<usize, Found> {
        if self.depth >= DEEPEST {
            return self.fail(Fault::TooDeep);
        }
        self.depth += 1;
        let result = part(self);
        self.depth -= 1;
        result
    }

    fn sum(&mut self) -> Result<usize, Found> {
        let mut left = self.product()?;
        while let Token::Sign(sign @ ('+' | '-')) = self.token {
            let at = self.start;
            self.advance()?;
            let right = self.product()?;
            let operation = if sign == '+' {
                Operation::Sum(left, right)
            } else {
                Operation::Difference(left, right)
            };
            left = self.building.push(operation, at)?;
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<usize, Found> {
        let mut left = self.sign()?;
        while let Token::Sign(sign @ ('*' | '/')) = self.token {
            self.advance()?;
            let at = self.start;
            let right = self.sign()?;
            let operation = if sign == '*' {
                Operation::Product(left, right)
            } else {
                Operation::Quotient(left, right)
            };
            left = self.building.push(operation, at)?;
        }
        Ok(left)
    }

    fn sign(&mut self) -> Result<usize, Found> {
        let at = self.start;
        match self.token {
            Token::Sign('-') => {
                self.advance()?;
                let inner = self.deeper(Self::sign)?;
                self.building.push(Operation::Negative(inner), at)
            }
            Token::Sign('+') => {
                self.advance()?;
                self.deeper(Self::sign)
            }
            _ => self.power(),
        }
    }

    fn power(&mut self) -> Result<usize, Found> {
        let at = self.start;
        let base = self.atom()?;
        if self.token != Token::Sign('^') {
            return Ok(base);
        }
        self.advance()?;
        let exponent = self.exponent()?;
        if self.token == Token::Sign('^') {
            return self.fail(Fault::PowerOfPower);
        }
        self.building.push(Operation::Power(base, exponent), at)
    }

    /// An integer with perhaps a sign, in parentheses or not.
    fn exponent(&mut self) -> Result<i64, Found> {
        let opened = self.start;
        let is_parenthesised = self.token == Token::Sign('(');
        if is_parenthesised {
            self.advance()?;
        }
        let is_negative = self.token == Token::Sign('-');
        if is_negative || self.token == Token::Sign('+') {
            self.advance()?;
        }
        let at = self.start;
        let digits = match self.token {
            Token::Number(digits) if digits.bytes().all(|byte| byte.is_ascii_digit()) => digits,
            Token::End => return self.fail(Fault::MissingValue(Token::End.to_string())),
            _ => return self.fail(Fault::NotAnInteger),
        };
        self.advance()?;
        if is_parenthesised {
            self.close(opened)?;
        }
        match digits.parse::<i64>() {
            Ok(size) if size <= LARGEST_EXPONENT => Ok(if is_negative { -size } else { size }),
            _ => Err((at, Fault::Exponent(shortened(digits)))),
        }
    }

    fn atom(&mut self) -> Result<usize, Found> {
        let at = self.start;
        match self.token {
            Token::Number(digits) => {
                let operation = number(digits).map_err(|fault| (at, fault))?;
                self.advance()?;
                self.building.push(operation, at)
            }
            Token::Word(word) => {
                self.advance()?;
                if self.token == Token::Sign('(') {
                    return self.call(word, at);
                }
                let operation = self.building.word(word).map_err(|fault| (at, fault))?;
                self.building.push(operation, at)
            }
            Token::Sign('(') => {
                self.advance()?;
                let inner = self.deeper(Self::sum)?;
                self.close(at)?;
                Ok(inner)
            }
            token => self.fail(Fault::MissingValue(token.to_string())),
        }
    }

    /// The arguments of a function, from the parenthesis on.
    fn call(&mut self, word: &str, at: usize) -> Result<usize, Found> {
        let function = self.building.function(word).map_err(|fault| (at, fault))?;
        let opened = self.start;
        self.advance()?;
        let mut arguments = Vec::new();
        if self.token != Token::Sign(')') {
            arguments.push(self.deeper(Self::sum)?);
            while self.token == Token::Sign(',') {
                self.advance()?;
                arguments.push(self.deeper(Self::sum)?);
            }
        }
        self.close(opened)?;
        if arguments.len() != function.arity() {
            let (takes, given) = (function.arity(), arguments.len());
            let function = function.name();
            return Err((at, Fault::Arguments { function, takes, given }));
        }
        self.building.push(Operation::Call(function, arguments), at)
    }

    /// Takes the closing parenthesis of one that was opened at a byte.
    fn close(&mut self, opened: usize) -> Result<(), Found> {
        match self.token {
            Token::Sign(')') => self.advance(),
            Token::Sign(',') => self.fail(Fault::Comma),
            Token::End => self.fail(Fault::Unclosed {
                opened: column(self.text, opened),
                found: Token::End.to_string(),
            }),
            token => self.fail(Fault::MissingOperator(token.to_string())),
        }
    }
}

/// The double nearest to a decimal, exactly.
fn number(digits: &str) -> Result<Operation, Fault> {
    let decimal = Rational::from_decimal(digits).ok_or_else(|| Fault::NotANumber(shortened(digits)))?;
    let double = Rational::from_f64(decimal.to_f64());
    let value = double.value().ok_or_else(|| Fault::TooLarge(shortened(digits)))?;
    let integer = value.is_integer().then(|| value.numer().to_i64()).flatten();
    Ok(integer.map_or(Operation::Number(double.clone()), Operation::Integer))
}

/// The character at a byte, counted from one.
fn column(text: &str, byte: usize) -> usize {
    text.get(..byte).map_or(0, |before| before.chars().count()) + 1
}

/// The text around a byte.
fn around(text: &str, byte: usize) -> String {
    let at = column(text, byte) - 1;
    let first = at.saturating_sub(SHOWN);
    let count = text.chars().skip(first).take(at - first + SHOWN).count();
    let part: String = text.chars().skip(first).take(count).collect();
    let before = if first > 0 { "…" } else { "" };
    let after = if text.chars().nth(first + count).is_some() {
        "…"
    } else {
        ""
    };
    format!("{before}{}{after}", printable(&part))
}
