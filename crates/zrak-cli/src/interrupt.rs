//! Ctrl-C, and the signal that ends a batch job: the first asks to stop, the second ends at once.

use std::sync::Arc;

use zrak::Control;

use crate::exit_codes::Exit;

/// A control that is stopped by Ctrl-C.
pub(crate) fn install() -> Arc<Control> {
    let control = Arc::new(Control::default());
    let stopped = Arc::clone(&control);
    let handler = move || {
        if stopped.is_stopped() {
            std::process::exit(Exit::Interrupted as i32);
        }
        stopped.stop();
    };
    // Without a handler Ctrl-C ends the process, which is what was asked for, if less politely.
    let _ = ctrlc::set_handler(handler);
    control
}
