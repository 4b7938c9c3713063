//! Ctrl-C: the first asks the run to end after the row at hand, the second ends the program at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user has asked the run to stop.
pub struct Interrupt {
    came: Arc<AtomicBool>,
}

impl Interrupt {
    /// Watches for Ctrl-C from now on. Where the system does not let us, Ctrl-C ends the program as it always did; rows already
    /// written are complete then, too.
    pub fn watch() -> Interrupt {
        let came = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&came);
        let _ = ctrlc::set_handler(move || {
            if seen.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        });
        Interrupt { came }
    }

    /// True once Ctrl-C was pressed.
    pub fn came(&self) -> bool {
        self.came.load(Ordering::Relaxed)
    }
}
