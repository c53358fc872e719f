//! The file of a suite: what is drawn, what it has to be, and who may say what it shall be.

mod case;
mod flags;
mod table;
#[cfg(test)]
mod tests;

pub(super) use case::Case;

use super::limits::Limit;
use crate::cli::environment::CacheArgs;
use crate::cli::error::CliError;
use crate::cli::glob;
use crate::cli::output;
use flags::Flag;
use std::path::{Path, PathBuf};
use table::{Source, Table, Value};

/// Golden files larger than this are refused, KiB, where the suite says nothing else.
const GOLDEN_KIB: u64 = 1024;

/// A suite that was read and found to be right, as far as that can be told without models.
#[derive(Debug)]
pub(super) struct Suite {
    pub(super) name: String,
    /// As it was named on the command line.
    pub(super) file: PathBuf,
    /// BLAKE3 of its bytes.
    pub(super) hash: String,
    /// The folder of all sets of goldens.
    goldens: PathBuf,
    set: GoldenSet,
    /// Patterns of the classes whose pictures may become goldens.
    bless: Vec<String>,
    pub(super) golden_bytes_max: u64,
    limits: Option<Vec<Limit>>,
    of_classes: Vec<(String, Vec<Limit>)>,
    pub(super) cases: Vec<Case>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum GoldenSet {
    /// One golden for all adapters.
    Any,
    /// One for each class of adapters.
    Class,
}

/// `[defaults]`: what cases have that say nothing else.
#[derive(Debug, Default)]
struct Defaults {
    flags: Vec<Flag>,
    limits: Option<Vec<Limit>>,
    mask: Option<PathBuf>,
    cache: CacheArgs,
}

impl Suite {
    /// Reads a suite.
    ///
    /// # Errors
    /// When it cannot be read, or with the line of what is wrong.
    pub(super) fn read(file: &Path, cache: &CacheArgs) -> Result<Self, CliError> {
        let text = std::fs::read_to_string(file)
            .map_err(|error| CliError::Usage(format!("{}: cannot be read: {error}", file.display())))?;
        Self::parse(file, &text, cache)
    }

    fn parse(file: &Path, text: &str, cache: &CacheArgs) -> Result<Self, CliError> {
        let shown = file.display().to_string();
        let source = Source { file: &shown, text };
        let parsed = source.parse()?;
        let root = Table::new(source, "a suite", 0..0, parsed.get_ref());
        let folder = file.parent().unwrap_or(Path::new(""));
        let stem = file.file_stem().and_then(|stem| stem.to_str()).unwrap_or("suite");

        let defaults = root.take("defaults").map(|value| Defaults::parse(&value.table()?)).transpose()?;
        let defaults = Defaults { cache: cache.clone(), ..defaults.unwrap_or_default() };
        let mut suite = Self {
            name: stem.to_owned(),
            file: file.to_owned(),
            hash: blake3::hash(text.as_bytes()).to_hex().to_string(),
            goldens: folder.join(format!("{stem}.goldens")),
            set: GoldenSet::Any,
            bless: Vec::new(),
            golden_bytes_max: GOLDEN_KIB << 10,
            limits: defaults.limits.clone(),
            of_classes: root.take("class").map(classes).transpose()?.unwrap_or_default(),
            cases: Vec::new(),
        };
        if let Some(value) = root.take("suite") {
            suite.take_header(&value.table()?, folder)?;
        }
        if let Some(value) = root.take("case") {
            for entry in value.array()? {
                let table = entry.table_called("[[case]]")?;
                suite.cases.extend(case::cases(source, &table, &defaults, folder)?);
            }
        }
        for (index, case) in suite.cases.iter_mut().enumerate() {
            case.index = index;
        }
        root.finish(&["suite", "defaults", "class", "case"])?;
        suite.check(source)?;
        Ok(suite)
    }

    fn take_header(&mut self, table: &Table<'_>, folder: &Path) -> Result<(), CliError> {
        if let Some(value) = table.take("name") {
            value.string()?.clone_into(&mut self.name);
        }
        if let Some(value) = table.take("goldens") {
            self.goldens = folder.join(value.string()?);
        }
        if let Some(value) = table.take("golden-set") {
            self.set = match value.string()? {
                "any" => GoldenSet::Any,
                "class" => GoldenSet::Class,
                other => {
                    return Err(value.error(format!("`{other}` is no set of goldens; there are any (one for all) and class (one for each class of adapters)")));
                }
            };
        }
        if let Some(value) = table.take("bless") {
            self.bless = value.strings()?.into_iter().map(|(pattern, _)| pattern.to_owned()).collect();
        }
        if let Some(value) = table.take("golden-kib") {
            self.golden_bytes_max = value.count()?.saturating_mul(1024);
        }
        table.finish(&["name", "goldens", "golden-set", "bless", "golden-kib"])
    }

    /// Every case is one of its own, and there is one.
    fn check(&self, source: Source<'_>) -> Result<(), CliError> {
        if self.cases.is_empty() {
            return Err(source.error(1, "the suite has no [[case]]"));
        }
        let mut first = std::collections::HashMap::new();
        for case in &self.cases {
            // Files of both would be one on systems that do not tell case apart.
            if let Some(line) = first.insert(case.id.to_lowercase(), case.line) {
                let problem = format!("case {} is there twice, first in line {line}; give it another name", case.id);
                return Err(source.error(case.line, problem));
            }
        }
        // A golden would need a name that is a folder already.
        let is_folder = |case: &&Case| {
            let prefix = format!("{}/", case.id.to_lowercase());
            first.keys().any(|id| id.starts_with(&prefix))
        };
        match self.cases.iter().find(is_folder) {
            Some(case) => {
                let problem = format!("case {} is also the folder of other cases; give it another name", case.id);
                Err(source.error(case.line, problem))
            }
            None => Ok(()),
        }
    }

    /// Where the golden of a case is, for pictures of a class.
    pub(super) fn golden(&self, id: &str, class: &str) -> PathBuf {
        let set = if self.set == GoldenSet::Any { "any" } else { class };
        self.goldens.join(set).join(format!("{id}.png"))
    }

    /// The folder of all sets of goldens.
    pub(super) fn goldens_folder(&self) -> &Path {
        &self.goldens
    }

    /// Removes what killed runs have left among the goldens.
    pub(super) fn clear_stale_goldens(&self) {
        output::clear_stale_below(&self.goldens);
    }

    /// The limits of a case: its own, those of the first class that the adapter is of, or the defaults.
    pub(super) fn limits<'a>(&'a self, case: &'a Case, class: &str) -> &'a [Limit] {
        let of_class = || self.of_classes.iter().find(|(pattern, _)| glob::matches(pattern, class));
        let limits = case.limits.as_ref().or_else(|| of_class().map(|(_, limits)| limits)).or(self.limits.as_ref());
        limits.map_or(&[], Vec::as_slice)
    }

    /// # Errors
    /// When pictures of this class may not become goldens.
    pub(super) fn check_may_bless(&self, class: &str) -> Result<(), CliError> {
        if self.bless.iter().any(|pattern| glob::matches(pattern, class)) {
            return Ok(());
        }
        let file = self.file.display();
        Err(CliError::Usage(if self.bless.is_empty() {
            format!(
                "{file}: no adapter may bless goldens; add bless = [\"{class}\"] to [suite] if pictures of {class} shall be the goldens"
            )
        } else {
            format!("{file}: pictures of {class} may not become goldens; those of {} may", self.bless.join(", "))
        }))
    }

    /// Where a run leaves what it finds, unless it is told: beside the suite.
    pub(super) fn default_out(&self) -> PathBuf {
        default_out(&self.file)
    }
}

/// [`Suite::default_out`] by the suite's file.
pub(super) fn default_out(suite: &Path) -> PathBuf {
    suite.with_extension("out")
}

impl Defaults {
    fn parse(table: &Table<'_>) -> Result<Self, CliError> {
        let limits = table.take("thresholds").map(limits_of).transpose()?;
        let mask = table.take("mask").map(|value| value.string().map(PathBuf::from)).transpose()?;
        let known = crate::cli::shot::names();
        let flag = |value: &Value<'_>| {
            if known.contains(&value.key) {
                return Flag::of(value);
            }
            Err(case::unknown(table, value, &["thresholds", "mask"], &known))
        };
        let flags = table.rest().map(flag).collect::<Result<_, _>>()?;
        Ok(Self { flags, limits, mask, cache: CacheArgs::default() })
    }
}

/// `[class.PATTERN]`: other limits for some adapters.
fn classes(value: &Value<'_>) -> Result<Vec<(String, Vec<Limit>)>, CliError> {
    let class = |value: &Value<'_>| {
        let table = value.table()?;
        let limits = table.take("thresholds").ok_or_else(|| value.error("this class has no `thresholds`"))?;
        let limits = limits_of(limits)?;
        table.finish(&["thresholds"])?;
        Ok((value.key.clone(), limits))
    };
    value.table()?.rest().map(class).collect()
}

/// The conditions of a list, all of which have to hold. There is one at least.
fn limits_of(value: &Value<'_>) -> Result<Vec<Limit>, CliError> {
    let texts = value.strings()?;
    if texts.is_empty() {
        return Err(value
            .error("`thresholds` is empty, so that no picture could fail; add one, such as \"flip.mean <= 0.004\""));
    }
    let limit =
        |(text, value): (&str, Value<'_>)| Limit::parse(text, value.place()).map_err(|problem| value.error(problem));
    texts.into_iter().map(limit).collect()
}
