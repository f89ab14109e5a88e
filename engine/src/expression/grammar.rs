//! Text → program.
//!
//! The grammar is given at the head of [`super`]. Every loop moves forward and every descent is counted, so the time
//! and the stack that a text takes are bounded by its length: [`LENGTH`], [`DEPTH`], [`OPERATIONS`].

use super::error::{
    DEPTH, FormulaError, LENGTH, NAME, OPERATIONS, SyntaxProblem, TextPlace, piece, piece_after_number,
};
use super::function::{Binary, Function, RADIUS, Unary, constant};
use super::program::{Op, Program};
use winnow::ascii::{digit0, digit1, multispace0};
use winnow::combinator::{alt, cut_err, opt, preceded};
use winnow::error::{ErrMode, ParserError};
use winnow::prelude::*;
use winnow::stream::{LocatingSlice, Location, Stateful, Stream};
use winnow::token::{one_of, take_while};

/// What is written while the text is read.
#[derive(Debug)]
struct ProgramWriter {
    program: Program,
    operations: usize,
    /// Whether r and parameters may occur in the text.
    variables: bool,
}

type FormulaInput<'a> = Stateful<LocatingSlice<&'a str>, &'a mut ProgramWriter>;

/// A problem at a byte offset.
#[derive(Debug)]
struct SyntaxFault {
    byte: usize,
    problem: SyntaxProblem,
}

/// Only where an operand must stand does the grammar fail without a message of its own.
impl ParserError<FormulaInput<'_>> for SyntaxFault {
    type Inner = Self;

    fn from_input(input: &FormulaInput<'_>) -> Self {
        // Blanks are skipped together with what follows them: here they are still in front of it.
        let rest: &str = input;
        let trimmed = rest.trim_ascii_start();
        let byte = input.current_token_start() + rest.len() - trimmed.len();
        let problem = match trimmed.chars().next() {
            Some(character) if !character.is_ascii() => SyntaxProblem::not_ascii(character),
            _ => SyntaxProblem::Operand { found: piece(trimmed) },
        };
        Self { byte, problem }
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

type Parsed<T = ()> = Result<T, ErrMode<SyntaxFault>>;

fn fail<T>(byte: usize, problem: SyntaxProblem) -> Parsed<T> {
    Err(ErrMode::Cut(SyntaxFault { byte, problem }))
}

/// The program of a text that is an expression in r and named parameters.
///
/// # Errors
/// What is wrong with the text, and where.
pub fn formula(text: &str) -> Result<Program, FormulaError> {
    let (program, end) = leading(text, true)?;
    let rest = &text[end..];
    if rest.is_empty() {
        return Ok(program);
    }
    Err(FormulaError {
        place: TextPlace::of(text, end),
        problem: after_operand(rest, "an operator or the end"),
    })
}

/// The program of the expression without variables at the start of a text, and the byte at which what follows begins.
///
/// # Errors
/// What is wrong with the text, and where.
pub fn number(text: &str) -> Result<(Program, usize), FormulaError> {
    leading(text, false)
}

fn leading(text: &str, variables: bool) -> Result<(Program, usize), FormulaError> {
    let at = |byte, problem| FormulaError { place: TextPlace::of(text, byte), problem };
    if let Some((byte, _)) = text.char_indices().nth(LENGTH) {
        return Err(at(byte, SyntaxProblem::TooLong));
    }
    let mut writer = ProgramWriter { program: Program::default(), operations: 0, variables };
    let mut input = Stateful { input: LocatingSlice::new(text), state: &mut writer };
    let end = |input: &mut FormulaInput| {
        sum(input, 0)?;
        blanks(input)?;
        Ok(input.current_token_start())
    };
    match end(&mut input) {
        Ok(end) => Ok((writer.program, end)),
        Err(ErrMode::Backtrack(fault) | ErrMode::Cut(fault)) => Err(at(fault.byte, fault.problem)),
        // Only a stream that is still coming in can be incomplete.
        Err(ErrMode::Incomplete(_)) => Err(at(text.len(), SyntaxProblem::Operand { found: piece("") })),
    }
}

/// What is wrong with `rest`, which follows a complete operand.
fn after_operand(rest: &str, expected: &'static str) -> SyntaxProblem {
    match rest.chars().next() {
        Some(c) if c.is_ascii_alphanumeric() || c == '(' => SyntaxProblem::Juxtaposed { found: piece(rest) },
        Some(c) if !c.is_ascii() => SyntaxProblem::not_ascii(c),
        _ => SyntaxProblem::Operator { expected, found: piece_after_number(rest) },
    }
}

fn blanks(input: &mut FormulaInput) -> Parsed {
    multispace0.void().parse_next(input)
}

/// One of the characters, if it comes next.
fn symbol<const N: usize>(input: &mut FormulaInput, of: [char; N]) -> Parsed<Option<char>> {
    opt(preceded(multispace0, one_of(of))).parse_next(input)
}

fn emit(input: &mut FormulaInput, op: Op) -> Parsed {
    let writer = &mut *input.state;
    writer.operations += usize::from(matches!(op, Op::Unary(_) | Op::Binary(_)));
    writer.program.ops.push(op);
    if writer.operations > OPERATIONS {
        return fail(input.current_token_start(), SyntaxProblem::TooManyOperations);
    }
    Ok(())
}

fn sum(input: &mut FormulaInput, depth: usize) -> Parsed {
    product(input, depth)?;
    while let Some(sign) = symbol(input, ['+', '-'])? {
        cut_err(|input: &mut FormulaInput| product(input, depth)).parse_next(input)?;
        emit(input, Op::Binary(if sign == '+' { Binary::Add } else { Binary::Subtract }))?;
    }
    Ok(())
}

fn product(input: &mut FormulaInput, depth: usize) -> Parsed {
    unary(input, depth)?;
    while let Some(sign) = symbol(input, ['*', '/'])? {
        cut_err(|input: &mut FormulaInput| unary(input, depth)).parse_next(input)?;
        emit(input, Op::Binary(if sign == '*' { Binary::Multiply } else { Binary::Divide }))?;
    }
    Ok(())
}

fn unary(input: &mut FormulaInput, depth: usize) -> Parsed {
    // A loop, not a descent: a row of signs takes no stack.
    let mut negative = false;
    while let Some(sign) = symbol(input, ['+', '-'])? {
        negative ^= sign == '-';
    }
    power(input, depth)?;
    if negative { emit(input, Op::Unary(Unary::Negate)) } else { Ok(()) }
}

fn power(input: &mut FormulaInput, depth: usize) -> Parsed {
    operand(input, depth)?;
    if symbol(input, ['^'])?.is_some() {
        let depth = deeper(input, depth)?;
        cut_err(|input: &mut FormulaInput| unary(input, depth)).parse_next(input)?;
        emit(input, Op::Binary(Binary::Power))?;
    }
    Ok(())
}

fn deeper(input: &FormulaInput, depth: usize) -> Parsed<usize> {
    if depth < DEPTH { Ok(depth + 1) } else { fail(input.current_token_start(), SyntaxProblem::TooDeep) }
}

fn operand(input: &mut FormulaInput, depth: usize) -> Parsed {
    let start = input.checkpoint();
    blanks(input)?;
    let operand = alt((
        literal,
        |input: &mut FormulaInput| named(input, depth),
        |input: &mut FormulaInput| enclosed(input, depth, false).map(|_| ()),
    ))
    .parse_next(input);
    if let Err(ErrMode::Backtrack(_)) = operand {
        input.reset(&start);
    }
    operand
}

fn literal(input: &mut FormulaInput) -> Parsed {
    let byte = input.current_token_start();
    let mantissa = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    let digits: &str = (mantissa, opt(exponent)).take().parse_next(input)?;
    match digits.parse() {
        Ok(number) if f64::is_finite(number) => emit(input, Op::Number(number)),
        _ => fail(byte, SyntaxProblem::LargeNumber { number: digits.chars().take(NAME).collect() }),
    }
}

fn named(input: &mut FormulaInput, depth: usize) -> Parsed {
    let byte = input.current_token_start();
    let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let name: &str =
        (one_of(|c: char| c.is_ascii_alphabetic()), take_while(0.., letters)).take().parse_next(input)?;
    if name.len() > NAME {
        return fail(byte, SyntaxProblem::LongName);
    }
    let owned = || name.to_owned();
    let called = input.trim_ascii_start().starts_with('(');
    if let Some(function) = Function::named(name) {
        if !called {
            return fail(byte, SyntaxProblem::Uncalled { name: owned() });
        }
        blanks(input)?;
        let given = enclosed(input, depth, true)?;
        let takes = function.arguments();
        if given != takes {
            return fail(byte, SyntaxProblem::Arguments { name: owned(), takes, given });
        }
        return emit(
            input,
            match function {
                Function::One(unary) => Op::Unary(unary),
                Function::Two(binary) => Op::Binary(binary),
            },
        );
    }
    if let Some(value) = constant(name) {
        return emit(input, Op::Number(value));
    }
    if called && name != RADIUS {
        return fail(byte, SyntaxProblem::UnknownFunction { name: owned() });
    }
    if !input.state.variables {
        return fail(byte, SyntaxProblem::Variable { name: owned() });
    }
    if name == RADIUS {
        return emit(input, Op::Radius);
    }
    let parameters = &mut input.state.program.parameters;
    let index = parameters.iter().position(|known| known == name).unwrap_or_else(|| {
        parameters.push(owned());
        parameters.len() - 1
    });
    emit(input, Op::Parameter(index))
}

/// One sum in parentheses, or several with `commas`; returns their number.
fn enclosed(input: &mut FormulaInput, depth: usize, commas: bool) -> Parsed<usize> {
    let opening = input.current_token_start();
    '('.parse_next(input)?;
    let depth = deeper(input, depth)?;
    let mut given = 0;
    loop {
        cut_err(|input: &mut FormulaInput| sum(input, depth)).parse_next(input)?;
        given += 1;
        if !commas || symbol(input, [','])?.is_none() {
            break;
        }
    }
    if symbol(input, [')'])?.is_some() {
        return Ok(given);
    }
    blanks(input)?;
    let byte = input.current_token_start();
    if input.is_empty() {
        // Offset and column are the same here: so far everything was ASCII.
        return fail(byte, SyntaxProblem::Unclosed { opened: opening + 1 });
    }
    fail(byte, after_operand(input, if commas { "an operator, ',' or ')'" } else { "an operator or ')'" }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        formula(text).unwrap().value()
    }

    fn refusal(text: &str) -> String {
        formula(text).unwrap_err().to_string()
    }

    #[test]
    fn precedence_is_that_of_mathematics() {
        for (text, expected) in [
            ("-2^2", -4.0),
            ("2^3^2", 512.0),
            ("2^-3", 0.125),
            ("2^-2^2", 0.0625),
            ("-2^-2", -0.25),
            ("1 - 2 - 3", -4.0),
            ("8/4/2", 1.0),
            ("8/4*2", 4.0),
            ("2*-3", -6.0),
            ("1--1", 2.0),
            ("-+-3", 3.0),
            ("(1+2)*3", 9.0),
            (" 1e-3\t", 1e-3),
            (".5+5.", 5.5),
            ("1.5E+2", 150.0),
            ("2*3^2", 18.0),
            ("min(1, max(2, 3)) + hypot(3, 4)", 6.0),
            ("pow(2, 3)^2", 64.0),
            ("ln(e^2) + log10(1000) + log(1)", 5.0),
            ("cos(pi) + abs(-3) + sign(-2) + step(0)", 2.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-15, "{text} = {}", value(text));
        }
        assert!(value("0/0").is_nan() && value("max(0/0, 1)").is_nan());
        assert!(value("10^10^10").is_infinite());
    }

    #[test]
    fn parameters_in_order_of_first_appearance() {
        let program = formula("r^2/(2*R) + A*(1 - cos(2*pi*r/lambda)) + A*e").unwrap();
        assert_eq!(program.parameters, ["R", "A", "lambda"]);
    }

    #[test]
    fn a_refusal_names_the_column_and_the_piece() {
        for (text, message) in [
            ("", "column 1: expected a number, a name or '(', found the end"),
            ("1 + ", "column 5: expected a number, a name or '(', found the end"),
            ("r*)", "column 3: expected a number, a name or '(', found ')'"),
            ("r**2", "column 3: expected a number, a name or '(', found '*'; powers are written with ^"),
            ("2 r", "column 3: an operator is missing before r: products are written with *"),
            ("2r", "column 2: an operator is missing before r: products are written with *"),
            ("(2 R)/r", "column 4: an operator is missing before R: products are written with *"),
            ("r(2)", "column 2: an operator is missing before '(': products are written with *"),
            ("R(2)", "column 1: there is no function R; a product is written R*(...)"),
            ("2*(r", "column 5: the '(' at column 3 is never closed"),
            ("(r]", "column 3: expected an operator or ')', found ']'"),
            ("r)", "column 2: expected an operator or the end, found ')'"),
            ("1,5", "column 2: expected an operator or the end, found ',' (use a decimal point)"),
            ("1.2.3", "column 4: expected an operator or the end, found '.'"),
            ("cos r", "column 1: cos is a function: write cos(...)"),
            ("sin()", "column 5: expected a number, a name or '(', found ')'"),
            ("sin(1, 2)", "column 1: sin takes 1 argument, not 2"),
            ("1+min(1)", "column 3: min takes 2 arguments, not 1"),
            ("2*π*r", "column 3: the character 'π' cannot occur in a formula: write pi"),
            ("r²", "column 2: the character '²' cannot occur in a formula: write ^2"),
            ("(é)", "column 2: the character 'é' cannot occur in a formula"),
            ("r\u{202e}", "column 2: the character '\\u{202e}' cannot occur in a formula"),
            ("r + \u{7}", "column 5: expected a number, a name or '(', found '\\u{7}'"),
            ("1e999", "column 1: the number 1e999 is too large"),
        ] {
            assert_eq!(refusal(text), message, "{text}");
        }
        let place = formula("2 * r + λ").unwrap_err().place;
        assert_eq!(place, TextPlace { byte: 8, column: 9 });
    }

    #[test]
    fn hostile_text_is_refused_with_the_limit() {
        let nested = |depth: usize| format!("{}r{}", "(".repeat(depth), ")".repeat(depth));
        assert!(formula(&nested(DEPTH)).is_ok());
        assert_eq!(formula(&nested(DEPTH + 1)).unwrap_err().problem, SyntaxProblem::TooDeep);
        assert_eq!(formula(&"sin(".repeat(1000)).unwrap_err().problem, SyntaxProblem::TooDeep);
        assert_eq!(formula(&"2^".repeat(2000)).unwrap_err().problem, SyntaxProblem::TooDeep);
        assert_eq!(formula(&"r+".repeat(2000)).unwrap_err().problem, SyntaxProblem::TooManyOperations);
        assert_eq!(formula(&"r".repeat(LENGTH)).unwrap_err().problem, SyntaxProblem::LongName);
        assert_eq!(formula(&"9".repeat(LENGTH)).unwrap_err().to_string().len(), 10 + 11 + NAME + 13);
        let long = formula(&" ".repeat(1 << 20)).unwrap_err();
        assert_eq!((long.problem, long.place.column), (SyntaxProblem::TooLong, LENGTH + 1));
        assert!(formula(&format!("{}1", "-".repeat(LENGTH - 1))).is_ok());
    }

    #[test]
    fn a_number_ends_where_its_unit_begins() {
        for (text, expected, rest) in [
            ("3*pi/2 um", 4.712_388_980_384_69, "um"),
            ("1e-3", 1e-3, ""),
            ("2eV", 2.0, "eV"),
            ("1 µm", 1.0, "µm"),
        ] {
            let (program, end) = number(text).unwrap();
            assert_eq!((program.value(), &text[end..]), (expected, rest));
        }
        assert_eq!(
            number("2*x").unwrap_err().to_string(),
            "column 3: x has no value here: only numbers, pi, e and functions of them"
        );
    }
}
