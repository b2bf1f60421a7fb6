//! Output files that are complete or not there at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use tempfile::NamedTempFile;

use super::partial::Partial;
use crate::error::FileError;

/// Where the process finds its standard output by a name.
pub const STANDARD_OUTPUT: &str = "/dev/stdout";

/// The file that is written when `path` is. If `path` is a symbolic link, this is the file to which
/// the link points, whether it exists or not. A device or a pipe has its own name, and `-` is
/// standard output.
pub fn target(path: &Path) -> PathBuf {
    const MOST_LINKS: usize = 40;
    if path == Path::new("-") {
        return STANDARD_OUTPUT.into();
    }
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&target) {
            Ok(link) if !is_stream(&target) => {
                target = target.parent().unwrap_or(Path::new("")).join(link);
            }
            _ => return target,
        }
    }
    path.to_owned()
}

/// A file that is written beside its target and gets the target's name when it is complete.
///
/// If it is dropped before [`publish`], it disappears and the target stays as it was. A device or a
/// pipe is written directly, because there is nothing to replace.
#[derive(Debug)]
pub struct OutputFile {
    /// The path that the user gave.
    path: PathBuf,
    destination: Destination,
}

/// A file that is complete and stored, and lacks only its name.
#[derive(Debug)]
#[must_use = "it disappears unless it is published"]
pub struct StoredFile(OutputFile);

#[derive(Debug)]
enum Destination {
    Beside { partial: Partial<NamedTempFile>, target: PathBuf },
    Direct { stream: File, unheard: bool },
}

impl OutputFile {
    /// Starts to write `path`, whose directory must exist.
    ///
    /// # Errors
    /// [`FileError::Output`]: the directory is missing or cannot be written, or `path` is a
    /// directory.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let target = target(path);
        let directory = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        Self::create_in(directory, path)
    }

    /// Starts to write `path`. The incomplete file is in `directory`, on the file system of the
    /// target.
    ///
    /// # Errors
    /// [`FileError::Output`]: `directory` is missing or cannot be written, or `path` is a
    /// directory.
    pub fn create_in(directory: &Path, path: &Path) -> Result<Self, FileError> {
        let destination = Destination::new(directory, path);
        let destination = destination.map_err(|error| FileError::output(path, error))?;
        Ok(Self { path: path.to_owned(), destination })
    }

    /// Writes `content` and stores the file.
    ///
    /// # Errors
    /// [`FileError::Output`]: it cannot be written.
    pub fn finish(mut self, content: &[u8]) -> Result<StoredFile, FileError> {
        self.write_all(content).map_err(|error| self.failure(error))?;
        self.store()
    }

    /// Makes sure that everything is stored on the disk.
    ///
    /// # Errors
    /// [`FileError::Output`]: the disk is full or fails.
    pub fn store(mut self) -> Result<StoredFile, FileError> {
        let stored = match &self.destination {
            Destination::Beside { partial, .. } => partial.as_file().sync_all(),
            Destination::Direct { .. } => self.flush(),
        };
        match stored {
            Ok(()) => Ok(StoredFile(self)),
            Err(error) => Err(self.failure(error)),
        }
    }

    /// Whether it is a pipe that nobody reads any more: the reader has seen enough.
    pub fn is_unheard(&self) -> bool {
        matches!(self.destination, Destination::Direct { unheard: true, .. })
    }

    /// The failure to write this file.
    pub fn failure(&self, error: impl Into<io::Error>) -> FileError {
        FileError::output(&self.path, error)
    }
}

impl StoredFile {
    /// The name of the file for readers.
    pub fn shown(&self) -> String {
        let OutputFile { path, .. } = &self.0;
        if target(path) == Path::new(STANDARD_OUTPUT) {
            "standard output".to_owned()
        } else {
            path.display().to_string()
        }
    }
}

/// Gives files their names. All of them are complete by now.
///
/// # Errors
/// [`FileError::Output`]: a file cannot be renamed. It is removed, and so are the files after it.
pub fn publish(files: impl IntoIterator<Item = StoredFile>) -> Result<(), FileError> {
    files.into_iter().try_for_each(|StoredFile(OutputFile { path, destination })| match destination
    {
        Destination::Beside { partial, target } => {
            partial.publish(&target).map_err(|error| FileError::output(&path, error))
        }
        Destination::Direct { .. } => Ok(()),
    })
}

/// Writes a file at once or not at all.
///
/// # Errors
/// [`FileError::Output`]: the file cannot be written.
pub fn write(path: &Path, content: &[u8]) -> Result<(), FileError> {
    publish([OutputFile::create(path)?.finish(content)?])
}

/// Writes a file at once or not at all, unless the power fails: it is not stored on the disk before
/// it gets its name.
///
/// # Errors
/// [`FileError::Output`]: the file cannot be written.
pub fn write_unsynchronised(path: &Path, content: &[u8]) -> Result<(), FileError> {
    let mut file = OutputFile::create(path)?;
    file.write_all(content).map_err(|error| file.failure(error))?;
    publish([StoredFile(file)])
}

impl Destination {
    fn new(directory: &Path, path: &Path) -> io::Result<Self> {
        let target = target(path);
        if is_stream(&target) {
            return Ok(Self::Direct { stream: stream(&target)?, unheard: false });
        }
        if target.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        fs::metadata(directory)?;
        let name = target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
        Ok(Self::Beside { partial: Partial::file(directory, name)?, target })
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.destination {
            // Writing to the `NamedTempFile` itself would add the temporary name to the error.
            Destination::Beside { partial, .. } => partial.as_file_mut().write(bytes),
            Destination::Direct { unheard: true, .. } => Ok(bytes.len()),
            Destination::Direct { stream, unheard } => match stream.write(bytes) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                    *unheard = true;
                    Ok(bytes.len())
                }
                written => written,
            },
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.destination {
            Destination::Beside { partial, .. } => partial.as_file_mut().flush(),
            Destination::Direct { stream, .. } => stream.flush(),
        }
    }
}

static CLOSED: AtomicBool = AtomicBool::new(false);

/// Notes that the process was started with a closed standard output. Rust has opened `/dev/null` in
/// its place, or its number belongs to another file.
pub fn note_closed_output() {
    CLOSED.store(true, Ordering::Relaxed);
}

/// Standard output.
///
/// # Errors
/// It is closed.
pub fn standard_output() -> io::Result<io::Stdout> {
    if CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::other("it is closed"));
    }
    Ok(io::stdout())
}

/// The stream to which `path` leads. A stream of the process is written where it stands.
fn stream(path: &Path) -> io::Result<File> {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        let own = |number: &str| OWN.iter().any(|own| path == Path::new(own).join(number));
        if path == Path::new(STANDARD_OUTPUT) || own("1") {
            return Ok(standard_output()?.as_fd().try_clone_to_owned()?.into());
        }
        if path == Path::new("/dev/stderr") || own("2") {
            return Ok(io::stderr().as_fd().try_clone_to_owned()?.into());
        }
    }
    // Another program may have written before.
    let stream = OpenOptions::new().append(true).open(path)?;
    if stream.metadata()?.is_file() {
        return Err(io::Error::other(
            "is a file that another program has opened; expected its name",
        ));
    }
    Ok(stream)
}

/// Where a process finds its streams by their numbers.
const OWN: [&str; 2] = ["/dev/fd", "/proc/self/fd"];

/// Whether `path` leads to a device, a pipe or a stream of the process. A file must not replace
/// these.
fn is_stream(path: &Path) -> bool {
    let own = [STANDARD_OUTPUT, "/dev/stderr"];
    own.iter().chain(&OWN).any(|stream| path.starts_with(stream))
        || fs::metadata(path).is_ok_and(|existing| !existing.is_file() && !existing.is_dir())
}
