//! What the terminal gets. A reader that has gone away (`moorline schema | head -1`) is no error and never a panic.

use crate::error::Error;
use std::io::{ErrorKind, Write};

/// Prints a text on standard output as it stands.
pub fn print(text: &str) -> Result<(), Error> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Error::File { path: "standard output".to_string(), reason: format!("cannot be written: {error}") })
        }
        _ => Ok(()),
    }
}

/// Prints `error: message` on standard error.
pub fn error(message: &str) {
    say("error", message);
}

/// Prints `warning: message` on standard error.
pub fn warning(message: &str) {
    say("warning", message);
}

fn say(kind: &str, message: &str) {
    // Where nobody reads standard error there is nobody left to tell.
    let _ = writeln!(std::io::stderr(), "{kind}: {}", on_terminal(message));
}

/// Prints what the argument parser has to say: help and version with exit code 0, mistakes with 2.
pub fn usage(answer: &clap::Error) -> u8 {
    let _ = answer.print();
    if answer.use_stderr() { 2 } else { 0 }
}

/// Text of the user as it may appear on a terminal: without control characters.
pub fn on_terminal(text: &str) -> String {
    text.chars().map(|c| if c.is_control() && c != '\n' { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_cannot_steer_the_terminal() {
        assert_eq!(on_terminal("a\u{1b}[2Jb"), "a [2Jb");
    }
}
