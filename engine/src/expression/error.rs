//! Why a text is not an expression, and where.

use thiserror::Error;

/// The most characters in an expression.
pub const LENGTH: usize = 4096;

/// The deepest nesting of parentheses, calls and powers.
pub const DEPTH: usize = 64;

/// The most operations in an expression: nobody types a gap with more.
pub const OPERATIONS: usize = 1000;

/// The most characters in a name, so that messages stay on one line.
pub const NAME: usize = 40;

/// A `*` where an operand was expected is the second one of a `**`.
const POWERS: &str = "; powers are written with ^";

/// A place in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TextPlace {
    /// The offset in bytes.
    pub byte: usize,
    /// The column in characters, counted from 1.
    pub column: usize,
}

impl TextPlace {
    /// The place of the byte `byte` of `text`.
    pub fn of(text: &str, byte: usize) -> Self {
        let before = text.char_indices().take_while(|&(at, _)| at < byte).count();
        Self { byte, column: before + 1 }
    }
}

/// Why a text is not a formula, and where.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("column {}: {problem}", place.column)]
pub struct FormulaError {
    /// Where it was noticed.
    pub place: TextPlace,
    /// What is wrong there.
    pub problem: SyntaxProblem,
}

/// What can be wrong with an expression. Foreign text in it is short and safe to show.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SyntaxProblem {
    /// More text than a formula may have.
    #[error("the text is longer than {LENGTH} characters")]
    TooLong,
    /// Parentheses, calls and powers nested too deeply.
    #[error("parentheses, functions and powers are nested more than {DEPTH} deep")]
    TooDeep,
    /// More operations than a formula may have.
    #[error("more than {OPERATIONS} operations")]
    TooManyOperations,
    /// A name of a parameter or function that is too long.
    #[error("a name is longer than {NAME} characters")]
    LongName,
    /// A number beyond the largest double.
    #[error("the number {number} is too large")]
    LargeNumber {
        /// The number as written.
        number: String,
    },
    /// Something else where a value must stand.
    #[error("expected a number, a name or '(', found {found}{}", if found == "'*'" { POWERS } else { "" })]
    Operand {
        /// What stands there.
        found: String,
    },
    /// Something else where an operator must stand.
    #[error("expected {expected}, found {found}")]
    Operator {
        /// What could stand there.
        expected: &'static str,
        /// What stands there.
        found: String,
    },
    /// Two values side by side.
    #[error("an operator is missing before {found}: products are written with *")]
    Juxtaposed {
        /// The second value.
        found: String,
    },
    /// A parenthesis that is never closed.
    #[error("the '(' at column {opened} is never closed")]
    Unclosed {
        /// The column of the parenthesis.
        opened: usize,
    },
    /// A character beyond ASCII.
    #[error("the character {character} cannot occur in a formula{}", hint(*instead))]
    NotAscii {
        /// The character, quoted.
        character: String,
        /// What to write in its place.
        instead: Option<&'static str>,
    },
    /// A name before a parenthesis that is not a function.
    #[error("there is no function {name}; a product is written {name}*(...)")]
    UnknownFunction {
        /// The name.
        name: String,
    },
    /// A function's name without its arguments.
    #[error("{name} is a function: write {name}(...)")]
    Uncalled {
        /// The name.
        name: String,
    },
    /// A function with more or fewer arguments than it takes.
    #[error("{name} takes {takes} argument{}, not {given}", if *takes == 1 { "" } else { "s" })]
    Arguments {
        /// The function.
        name: String,
        /// How many it takes.
        takes: usize,
        /// How many it was given.
        given: usize,
    },
    /// A variable where only numbers may stand.
    #[error("{name} has no value here: only numbers, pi, e and functions of them")]
    Variable {
        /// The name.
        name: String,
    },
}

fn hint(instead: Option<&str>) -> String {
    instead.map_or_else(String::new, |instead| format!(": write {instead}"))
}

/// What to write for a character that people paste from a text.
fn in_ascii(character: char) -> Option<&'static str> {
    Some(match character {
        '−' | '–' => "-",
        '×' | '·' | '⋅' | '∙' => "*",
        '÷' | '∕' => "/",
        '²' => "^2",
        '³' => "^3",
        '√' => "sqrt(...)",
        'π' => "pi",
        'λ' => "lambda",
        '\u{a0}' => "a plain space",
        _ => return None,
    })
}

impl SyntaxProblem {
    /// The problem of a character beyond ASCII.
    pub(super) fn not_ascii(character: char) -> Self {
        Self::NotAscii { character: quoted(character), instead: in_ascii(character) }
    }
}

/// One character for a message: what must not reach a terminal is escaped.
fn quoted(character: char) -> String {
    format!("'{}'", character.escape_debug())
}

/// The word or the character at the start of `rest`, for a message.
pub fn piece(rest: &str) -> String {
    let Some(first) = rest.chars().next() else { return "the end".to_owned() };
    let word: String = rest.chars().take_while(char::is_ascii_alphanumeric).take(NAME).collect();
    if word.is_empty() { quoted(first) } else { word }
}

/// The same after a complete number, where a comma may have been meant as a decimal point.
pub fn piece_after_number(rest: &str) -> String {
    let found = piece(rest);
    if rest.starts_with(',') { format!("{found} (use a decimal point)") } else { found }
}
