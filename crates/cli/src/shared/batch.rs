//! A file with a case in each row, which is read in portions, computed in parallel, and written in
//! the order of the input.

mod piece;

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use stickslip_files::input::rows::{Input, Reading, Row};
use stickslip_files::output::csv::{CsvFile, Rows};
use stickslip_files::output::file::{STANDARD_OUTPUT, StoredFile};

use super::files::{Named, require_different};
use super::threads;
use crate::error::Failure;
use crate::output::console::{counted, deliver};
use crate::output::progress::Bar;
use piece::piece;

/// Rows are computed together until their collisions have about this many switches, which take
/// 50 MB as text, beside those that are written meanwhile. The memory of more rows is then that of
/// the largest collision.
const SWITCHES: f64 = 5e5;

/// The column that tells whether a row has results.
const STATUS: &str = "status";

/// A file with a case in each row, and the files for the results.
#[derive(Clone, Debug, clap::Args)]
pub struct BatchArguments {
    /// CSV file with a header row and one case per row; - is standard input
    #[arg(long, value_name = "IN.csv", help_heading = "Batch")]
    pub batch: Option<PathBuf>,

    /// CSV file for the results, one row per case in the order of the input [default: standard
    /// output]
    #[arg(long, value_name = "OUT.csv", help_heading = "Batch", requires = "batch")]
    pub out: Option<PathBuf>,

    /// CSV file for every switch of every case
    #[arg(long, value_name = "EV.csv", help_heading = "Batch", requires = "batch")]
    pub events: Option<PathBuf>,

    /// Threads; 1 to 1024 [default: RAYON_NUM_THREADS, or one for each core]; results do not depend
    /// on it
    #[arg(long, value_name = "N", help_heading = "Batch", allow_hyphen_values = true)]
    #[arg(value_parser = threads::threads())]
    pub threads: Option<u16>,
}

/// The files of a batch.
#[derive(Clone, Copy, Debug)]
pub struct BatchFiles<'a> {
    /// The file of the cases.
    pub input: &'a Path,
    out: &'a Path,
    events: Option<&'a Path>,
    threads: Option<u16>,
}

impl BatchArguments {
    /// The files that the options name, beside other inputs; `None` without a batch.
    pub fn files(&self, inputs: &[Named]) -> Result<Option<BatchFiles<'_>>, Failure> {
        let Some(input) = &self.batch else {
            // Beside an argument that excludes --batch, the parser does not ask for it.
            let given = [("--out", self.out.is_some()), ("--events", self.events.is_some())];
            return match given.into_iter().find(|(_, is_given)| *is_given) {
                Some((option, _)) => Err(Failure::Usage(format!(
                    "{option} has no effect without --batch; expected both"
                ))),
                None => Ok(None),
            };
        };
        let out = self.out.as_deref().unwrap_or(Path::new(STANDARD_OUTPUT));
        let inputs = [&[("--batch", Some(&**input))], inputs].concat();
        let events = self.events.as_deref();
        require_different(&[("--out", Some(out)), ("--events", events)], &inputs)?;
        Ok(Some(BatchFiles { input, out, events, threads: self.threads }))
    }
}

/// What is computed for the rows of a file.
pub trait Work: Sync {
    /// What a row gives.
    type Case: Send + Sync;

    /// The columns of results, `status` among them.
    fn results(&self) -> &[&'static str];

    /// The columns of the file of switches.
    fn events(&self) -> &'static [&'static str];

    /// About the number of switches.
    fn switches(&self, case: &Self::Case) -> f64;

    /// Writes the results of a case, and its switches if they are `wanted`, with its number.
    /// Returns whether everything could be computed, which `status` says too.
    fn write(
        &self,
        case: &Self::Case,
        results: &mut Rows,
        wanted: Option<(&mut Rows, u64)>,
    ) -> Result<bool, String>;
}

/// Computes every row of the input; `by` is what computes them, after a blank, or nothing.
///
/// # Errors
/// The input cannot be read, an output cannot be written, or some rows have no result. In the last
/// case the outputs are complete.
pub fn run<R: Reading>(
    files: BatchFiles<'_>,
    mut input: Input<R>,
    work: &impl Work<Case = R::Case>,
    by: &str,
) -> Result<(), Failure> {
    let pool = threads::pool(files.threads)?;
    let mut output = Output::create(files)?;
    let names = work.results().iter().map(|name| name.as_bytes());
    output.results.write(&header(input.header().iter().chain(names)))?;
    if let Some(events) = &mut output.events {
        events.write(&header(work.events()))?;
    }

    let bar = Bar::bytes(input.size());
    let (mut count, mut failed) = (0, 0);
    let (mut portion, mut next) = (Vec::new(), Vec::new());
    let (mut computed, mut ready) = (Vec::new(), Vec::new());
    pool.install(|| input.read_portion(&mut portion))?;
    while !portion.is_empty() && !output.is_unheard() {
        let position = input.position();
        let mut rest = &portion[..];
        while !rest.is_empty() {
            let (present, later) = rest.split_at(together(work, rest));
            // The rows before these are written meanwhile, and while the last ones of this portion
            // are computed, the next portion is read.
            let wanted = output.events.is_some();
            let compute = || compute(work, present, (count, wanted), &mut computed);
            let read = || if later.is_empty() { input.read_portion(&mut next) } else { Ok(()) };
            let write = || output.write(&ready);
            let (((), read), written) = pool.join(|| rayon::join(compute, read), write);
            written?;
            failed += computed.iter().map(|part| part.failed).sum::<u64>();
            std::mem::swap(&mut computed, &mut ready);
            if read.is_err() {
                output.write(&ready)?;
            }
            read?;
            count += present.len() as u64;
            rest = later;
        }
        std::mem::swap(&mut portion, &mut next);
        bar.reach(position);
    }
    output.write(&ready)?;
    drop(bar);

    let found = counted(usize::try_from(count - failed).unwrap_or(usize::MAX), "row", "rows");
    deliver(pool.install(|| output.store())?, format_args!("{found} computed{by}"))?;
    if failed > 0 {
        return Err(Failure::Rows { failed, rows: count, path: files.out.to_owned() });
    }
    Ok(())
}

/// The files of a batch.
struct Output {
    results: CsvFile,
    events: Option<CsvFile>,
}

impl Output {
    fn create(files: BatchFiles<'_>) -> Result<Self, Failure> {
        let results = CsvFile::create(files.out)?;
        let events = files.events.map(CsvFile::create).transpose()?;
        Ok(Self { results, events })
    }

    fn write(&mut self, parts: &[Computed]) -> Result<(), Failure> {
        for part in parts {
            self.results.write(&part.results)?;
            if let Some(events) = &mut self.events {
                events.write(&part.events)?;
            }
        }
        Ok(())
    }

    /// Whether nobody reads any of them any more.
    fn is_unheard(&self) -> bool {
        self.results.is_unheard() && self.events.as_ref().is_none_or(CsvFile::is_unheard)
    }

    fn store(self) -> Result<Vec<StoredFile>, Failure> {
        let Self { results, events } = self;
        let (results, events) =
            rayon::join(|| results.store(), || events.map(CsvFile::store).transpose());
        Ok([Some(results?), events?].into_iter().flatten().collect())
    }
}

/// The header of a file.
fn header<T: AsRef<[u8]>>(names: impl IntoIterator<Item = T>) -> Rows {
    let mut header = Rows::default();
    header.fields(names);
    header.end();
    header
}

/// The number of the first `rows` that are computed together.
fn together<W: Work>(work: &W, rows: &[Row<W::Case>]) -> usize {
    let mut switches = 0.0;
    let fits = rows.iter().take_while(|row| {
        let before = switches;
        switches += row.case.as_ref().map_or(0.0, |case| work.switches(case));
        before < SWITCHES
    });
    fits.count()
}

/// What successive rows of the input make.
#[derive(Default)]
struct Computed {
    results: Rows,
    events: Rows,
    /// The number of rows without a result.
    failed: u64,
}

/// Computes `rows`, the first of which is the case `first`, with their switches if they are
/// `wanted`. Rows do not depend on each other, and so results do not depend on the order of the
/// work.
fn compute<W: Work>(
    work: &W,
    rows: &[Row<W::Case>],
    (first, wanted): (u64, bool),
    computed: &mut Vec<Computed>,
) {
    let piece = piece(rows.len(), rayon::current_num_threads());
    computed.resize_with(rows.len().div_ceil(piece), Computed::default);
    let pieces = computed.par_iter_mut().zip(rows.par_chunks(piece)).enumerate();
    pieces.for_each(|(index, (part, rows))| {
        let Computed { results, events, failed } = part;
        results.clear();
        events.clear();
        *failed = 0;
        for (row, number) in rows.iter().zip(first + (index * piece) as u64..) {
            results.fields(&row.fields);
            let events = wanted.then_some((&mut *events, number));
            let written = match &row.case {
                Ok(case) => work.write(case, results, events),
                Err(reason) => Err(reason.clone()),
            };
            if let Err(reason) = &written {
                let blank = |name: &&str| if *name == STATUS { reason } else { "" };
                results.fields(work.results().iter().map(blank));
            }
            results.end();
            *failed += u64::from(written != Ok(true));
        }
    });
}
