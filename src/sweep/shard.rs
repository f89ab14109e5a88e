//! A part of the rows: every n-th one.
//!
//! Neighbouring rows cost about the same, so dealing them out in turn balances the load; the parts are joined by taking
//! rows in turn again.

use std::fmt;
use std::str::FromStr;

/// The largest number of parts; all are open at once when they are joined.
pub const MOST_SHARDS: u64 = 1000;

/// The part i of n.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub number: u64,
    pub of: u64,
}

impl Shard {
    /// The only part, which is the whole.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// How many of `rows` belong to it.
    pub fn len(self, rows: u64) -> u64 {
        (rows + self.of - self.number) / self.of
    }

    /// Whether none of `rows` belongs to it.
    pub fn is_empty(self, rows: u64) -> bool {
        self.len(rows) == 0
    }

    /// Its `index`-th row, from 0.
    pub fn row(self, index: u64) -> u64 {
        self.number - 1 + index * self.of
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let whole = |part: &str| part.parse::<u64>().ok();
        let parts = text.split_once('/').and_then(|(number, of)| whole(number).zip(whole(of)));
        match parts {
            Some((number, of)) if of <= MOST_SHARDS && (1..=of).contains(&number) => Ok(Self { number, of }),
            _ => Err(format!("expected i/n with i from 1 to n and n at most {MOST_SHARDS}, such as 3/8")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_disjoint_and_make_the_whole() {
        for rows in [0, 1, 7, 8, 9, 100] {
            for of in [1, 2, 3, 8] {
                let mut all = Vec::new();
                for number in 1..=of {
                    let shard = Shard { number, of };
                    assert_eq!(shard.is_empty(rows), shard.len(rows) == 0);
                    all.extend((0..shard.len(rows)).map(|index| shard.row(index)));
                }
                all.sort_unstable();
                assert!(all.iter().copied().eq(0..rows), "{rows} {of}: {all:?}");
            }
        }
    }

    #[test]
    fn a_shard_reads_what_it_prints() {
        for text in ["1/1", "3/8", "1000/1000"] {
            assert_eq!(text.parse::<Shard>().unwrap().to_string(), text);
        }
        for text in ["", "3", "0/8", "9/8", "1/0", "1/1001", "a/b", "-1/8", "1/8/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
