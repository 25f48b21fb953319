//! A process and its children, which can be ended together.

use std::io;
use std::process::{Child, Command};
use std::sync::{Mutex, PoisonError};

/// The running group.
static RUNNING: Mutex<Option<u32>> = Mutex::new(None);

/// Ends the running group.
pub fn end_running() {
    let running = *RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(leader) = running {
        kill(leader);
    }
}

/// A process with its children.
pub struct Group {
    /// The process id of the first process.
    leader: u32,
}

impl Group {
    /// Starts a process as the leader of a group.
    pub fn spawn(command: &mut Command) -> io::Result<(Child, Self)> {
        // The terminal sends Ctrl-C only to this program's group, so this handler ends the plugin's. With `--watch`,
        // that handler does it.
        let _ = ctrlc::try_set_handler(|| {
            end_running();
            std::process::exit(INTERRUPTED);
        });
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        let child = command.spawn()?;
        let leader = child.id();
        *RUNNING.lock().unwrap_or_else(PoisonError::into_inner) = Some(leader);
        Ok((child, Self { leader }))
    }

    /// Ends all processes of the group.
    pub fn end(&self) {
        kill(self.leader);
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        *RUNNING.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// The exit status of a program that Ctrl-C ends.
const INTERRUPTED: i32 = 130;

#[cfg(unix)]
fn kill(leader: u32) {
    use nix::sys::signal::{Signal, killpg};
    use nix::unistd::Pid;
    if let Ok(leader) = i32::try_from(leader) {
        // The processes may have ended already.
        let _ = killpg(Pid::from_raw(leader), Signal::SIGKILL);
    }
}

#[cfg(not(unix))]
fn kill(leader: u32) {
    // The processes may have ended already.
    let _ = Command::new("taskkill")
        .args(["/T", "/F", "/PID", &leader.to_string()])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .status();
}
