//! Files and directories that are not complete. None of them stays, however the program ends,
//! unless it is killed at once.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::io;
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::{Builder, NamedTempFile, TempDir};

/// How the name of an incomplete file ends.
const SUFFIX: &str = ".partial";

/// The paths of all that is not complete.
static INCOMPLETE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Something that disappears unless it is published.
#[derive(Debug)]
pub struct Partial<T> {
    inner: T,
    /// It ends after the file.
    listed: Listed,
}

/// The path of something that is not complete.
#[derive(Debug)]
struct Listed(PathBuf);

impl Partial<NamedTempFile> {
    /// A file in `directory` that will be called `name`.
    ///
    /// # Errors
    /// It cannot be created.
    pub fn file(directory: &Path, name: &OsStr) -> io::Result<Self> {
        Self::new(name, NamedTempFile::path, |builder| {
            #[cfg(unix)]
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
            builder.tempfile_in(directory)
        })
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// It cannot be renamed. It is removed.
    pub fn publish(self, target: &Path) -> io::Result<()> {
        let Self { inner, listed: _listed } = self;
        inner.persist(target).map(drop).map_err(|failed| failed.error)
    }
}

impl Partial<TempDir> {
    /// A directory beside `target`, of which it will have the name.
    ///
    /// # Errors
    /// It cannot be created.
    pub fn directory(target: &Path) -> io::Result<Self> {
        let name = target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
        let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty());
        let parent = parent.unwrap_or(Path::new("."));
        Self::new(name, TempDir::path, |builder| builder.tempdir_in(parent))
    }

    /// Gives the directory its name.
    ///
    /// # Errors
    /// It cannot be renamed. It is removed.
    pub fn publish(self, target: &Path) -> io::Result<()> {
        fs::rename(self.path(), target)?;
        let Self { inner, listed: _listed } = self;
        // It has another name now, under which it stays.
        let _ = inner.keep();
        Ok(())
    }
}

impl<T> Partial<T> {
    fn new(
        name: &OsStr,
        path: fn(&T) -> &Path,
        create: impl FnOnce(&mut Builder) -> io::Result<T>,
    ) -> io::Result<Self> {
        let mut prefix = OsString::from(".");
        prefix.push(name);
        prefix.push(".");
        // Nothing is created between a signal and the end.
        let mut incomplete = incomplete();
        let inner = create(Builder::new().prefix(&prefix).suffix(SUFFIX));
        // The whole error would show the temporary name, which the user does not know.
        let inner = inner.map_err(|error| plain(&error))?;
        let listed = Listed(path(&inner).to_owned());
        incomplete.insert(listed.0.clone());
        Ok(Self { inner, listed })
    }
}

impl<T> Deref for Partial<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.inner
    }
}

impl<T> DerefMut for Partial<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.inner
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        incomplete().remove(&self.0);
    }
}

fn incomplete() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    INCOMPLETE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The name that the incomplete file `name` would have got.
pub fn completed(name: &OsStr) -> Option<&str> {
    let (name, random) =
        name.to_str()?.strip_prefix('.')?.strip_suffix(SUFFIX)?.rsplit_once('.')?;
    random.bytes().all(|byte| byte.is_ascii_alphanumeric()).then_some(name)
}

/// Removes everything that is not complete when a signal ends the program.
///
/// Signals that were ignored when the program began, as `nohup` does, are still ignored.
///
/// # Errors
/// The signals cannot be watched.
#[cfg(unix)]
pub fn remove_on_signals() -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let ignored = ignored_signals();
    let watched = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|n| ignored >> (n - 1) & 1 == 0);
    let mut signals = Signals::new(watched)?;
    std::thread::spawn(move || {
        for signal in signals.forever() {
            // Others wait for this lock from here on.
            let incomplete = incomplete();
            for path in &*incomplete {
                // It is one or the other, or has just been published.
                let _ = fs::remove_file(path);
                let _ = fs::remove_dir_all(path);
            }
            let _ = emulate_default_handler(signal);
        }
    });
    Ok(())
}

/// The signals that this process ignores, as bits from signal 1 on. None is known outside Linux.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// What the system reports, without the hidden name that is added to it.
fn plain(error: &io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(" at path ") {
        Some((system, _)) => io::Error::new(error.kind(), system),
        None => error.kind().into(),
    }
}
