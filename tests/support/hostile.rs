//! Runs many hostile command lines, each by its number.

use std::collections::BTreeMap;

/// Tries these numbers, fails with a list of what is wrong, and counts the exit statuses.
pub fn run(
    numbers: impl Iterator<Item = u64>,
    judge: fn(u64) -> Result<i32, String>,
) -> BTreeMap<i32, usize> {
    let (mut statuses, mut wrong) = (BTreeMap::new(), Vec::new());
    for number in numbers {
        match judge(number) {
            Ok(status) => *statuses.entry(status).or_default() += 1,
            Err(what) => wrong.push(what),
        }
    }
    println!("by exit status: {statuses:?}");
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
    statuses
}
