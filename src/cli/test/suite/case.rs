//! Cases: one table of the file, and what its matrix makes of it.

use super::flags::Flag;
use super::table::{Source, Table, Value};
use super::{Defaults, limits_of};
use crate::cli::error::CliError;
use crate::cli::shot::{self, ShotArgs};
use crate::cli::test::limits::Limit;
use crate::cli::test::report::Kind;
use std::path::{Path, PathBuf};

/// Keys of a case that are no flags.
const KEYS: [&str; 8] = ["name", "model", "kind", "thresholds", "mask", "skip", "within", "matrix"];
/// Flags that a furnace sets itself, or that would put light into it.
const NOT_OF_FURNACES: [&str; 9] = [
    "env",
    "env-rotation",
    "env-intensity",
    "background",
    "background-blur",
    "light",
    "exposure",
    "tone-map",
    "debug-view",
];
/// More cases than this of one matrix are a slip of the pen.
const MATRIX_MAX: usize = 10_000;

/// One picture to draw and to judge.
#[derive(Debug)]
pub(in crate::cli::test) struct Case {
    /// Unique; also the path of its files, with `/`.
    pub(in crate::cli::test) id: String,
    /// Its place among the cases of the suite, from 0.
    pub(in crate::cli::test) index: usize,
    /// Where it begins in the file, from 1.
    pub(in crate::cli::test) line: usize,
    pub(in crate::cli::test) kind: Kind,
    /// The model as the suite names it.
    pub(in crate::cli::test) model: String,
    /// Flags in the order of their names, as the suite has them.
    pub(in crate::cli::test) settings: Vec<String>,
    pub(in crate::cli::test) args: ShotArgs,
    /// `None` where those of the adapter's class or of `[defaults]` are meant.
    pub(in crate::cli::test) limits: Option<Vec<Limit>>,
    pub(in crate::cli::test) mask: Option<PathBuf>,
    pub(in crate::cli::test) skip: Option<Skip>,
    /// How far the radiance in a white furnace may be from 1, and the place that says so.
    pub(in crate::cli::test) within: Option<(f64, String)>,
}

impl Case {
    /// BLAKE3 of the flags.
    pub(in crate::cli::test) fn settings_hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for setting in &self.settings {
            hasher.update(&(setting.len() as u64).to_le_bytes()).update(setting.as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }
}

/// Why a case is left out, and until when.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::cli::test) struct Skip {
    pub(in crate::cli::test) reason: String,
    /// Year, month and day of the last day without it.
    pub(in crate::cli::test) until: (u16, u8, u8),
}

/// All cases of one `[[case]]`.
///
/// # Errors
/// With the line of what is wrong.
pub(super) fn cases(
    source: Source<'_>,
    table: &Table<'_>,
    defaults: &Defaults,
    folder: &Path,
) -> Result<Vec<Case>, CliError> {
    let required = |key: &str| table.take(key).ok_or_else(|| table.error(format!("{} has no `{key}`", table.name)));
    let name = required("name")?;
    check_name(name)?;
    let kind = table.take("kind").map_or(Ok(Kind::Golden), kind)?;
    let own = Own {
        kind,
        limits: table.take("thresholds").map(limits_of).transpose()?,
        mask: table.take("mask").map(|value| value.string().map(PathBuf::from)).transpose()?,
        skip: table.take("skip").map(skip).transpose()?,
        within: table.take("within").map(within).transpose()?,
    };
    own.check(table, defaults)?;
    let matrix = table.take("matrix").map(|value| matrix(value, kind)).transpose()?.unwrap_or_default();
    let model = table.take("model");
    let flags = own_flags(table, kind)?;
    let mut cases = Vec::new();
    for combination in combinations(&matrix) {
        let varied = |name: &str| combination.iter().find(|flag| flag.name == name);
        let model = match (varied("model").and_then(|flag| flag.value()), model) {
            (Some(model), _) => model.to_owned(),
            (None, Some(model)) => model.string()?.to_owned(),
            (None, None) => return Err(table.error(format!("{} has no `model`", table.name))),
        };
        let varying: Vec<Flag> = combination.iter().filter(|flag| flag.name != "model").map(|f| (*f).clone()).collect();
        if let Some(flag) = varying.iter().find(|flag| flags.iter().any(|own| own.name == flag.name)) {
            return Err(
                source.error(flag.line, format!("`{}` is in the matrix and beside it; take one out", flag.name))
            );
        }
        let id = [name.string()?.to_owned()].into_iter().chain(suffix(&combination)).collect::<Vec<_>>().join("/");
        let all = merged(defaults, &flags, varying, kind);
        cases.push(own.case(source, (id, table.line), model, &all, (defaults, folder))?);
    }
    Ok(cases)
}

/// What all cases of a table have alike, beside flags.
struct Own {
    kind: Kind,
    limits: Option<Vec<Limit>>,
    mask: Option<PathBuf>,
    skip: Option<Skip>,
    within: Option<(f64, String)>,
}

impl Own {
    /// Every case has something that it can fail.
    fn check(&self, table: &Table<'_>, defaults: &Defaults) -> Result<(), CliError> {
        let is_furnace = self.kind == Kind::Furnace;
        let name = &table.name;
        Err(table.error(match (is_furnace, &self.limits, &self.within) {
            (true, Some(_), _) => format!("{name} is a furnace: it has `within` instead of `thresholds`"),
            (true, _, None) => format!("{name} is a furnace and has no `within`, such as \"0.5%\""),
            (true, ..) if self.mask.is_some() => format!("{name} is a furnace, which no `mask` is for"),
            (false, _, Some(_)) => format!("`within` is for furnaces; {name} has `thresholds`"),
            (false, None, _) if defaults.limits.is_none() => {
                format!(
                    "{name} has no thresholds, and neither has [defaults]; add some, such as \"flip.mean <= 0.004\""
                )
            }
            _ => return Ok(()),
        }))
    }

    fn case(
        &self,
        source: Source<'_>,
        (id, line): (String, usize),
        model: String,
        flags: &[Flag],
        (defaults, folder): (&Defaults, &Path),
    ) -> Result<Case, CliError> {
        let mut arguments: Vec<String> = flags.iter().flat_map(|flag| flag.arguments_from(folder)).collect();
        if self.kind == Kind::Furnace {
            arguments.extend(["--env=white", "--background=transparent"].map(str::to_owned));
        }
        let line_of = |name: &str| flags.iter().find(|flag| flag.name == name).map_or(line, |flag| flag.line);
        let mut args = shot::parse(&folder.join(&model), &arguments).map_err(|(name, problem)| {
            source.error(name.map_or(line, |name| line_of(&name)), format!("case {id}: {problem}"))
        })?;
        args.subject
            .check_lights()
            .map_err(|problem| source.error(line_of("light"), format!("case {id}: {problem}")))?;
        if model == "-" {
            return Err(source.error(line, format!("case {id}: a model of a suite is a file, not stdin")));
        }
        args.subject.set_cache(&defaults.cache);
        let mask = self.mask.as_ref().or(defaults.mask.as_ref().filter(|_| self.kind != Kind::Furnace));
        Ok(Case {
            id,
            // Known when all cases are.
            index: 0,
            line,
            kind: self.kind,
            model,
            settings: flags.iter().flat_map(|flag| flag.arguments().collect::<Vec<_>>()).collect(),
            args,
            limits: self.limits.clone(),
            mask: mask.map(|mask| folder.join(mask)),
            skip: self.skip.clone(),
            within: self.within.clone(),
        })
    }
}

/// The flags of a case in the order of their names: a default gives way to the case's own, and those to the matrix.
fn merged(defaults: &Defaults, own: &[Flag], varying: Vec<Flag>, kind: Kind) -> Vec<Flag> {
    let mut flags = varying;
    let suits =
        |flag: &&Flag| (kind == Kind::Reference || !shot::is_of_reference(&flag.name)) && !is_foreign(&flag.name, kind);
    for flag in own.iter().chain(defaults.flags.iter().filter(suits)) {
        if !flags.iter().any(|other| other.name == flag.name) {
            flags.push(flag.clone());
        }
    }
    flags.sort_by(|a, b| a.name.cmp(&b.name));
    flags
}

fn is_foreign(name: &str, kind: Kind) -> bool {
    kind == Kind::Furnace && NOT_OF_FURNACES.contains(&name)
}

fn own_flags(table: &Table<'_>, kind: Kind) -> Result<Vec<Flag>, CliError> {
    let known = shot::names();
    let flag = |value: &Value<'_>| {
        check_flag(value, &known, kind, || unknown(table, value, &KEYS, &known))?;
        Flag::of(value)
    };
    table.rest().map(flag).collect()
}

/// What to say of a key that is neither a flag nor one of `keys`.
pub(super) fn unknown(table: &Table<'_>, value: &Value<'_>, keys: &[&str], flags: &[String]) -> CliError {
    match value.key.as_str() {
        "times" => value.error("animations are not played, so that there is one time alone: leave out `times`"),
        "variants" => value.error("write several variants as matrix = { variant = [\"A\", \"B\"] }"),
        "views" => value
            .error("write several views as matrix = { camera = [0, 1] } or matrix = { orbit = [[30, 75], [60, 75]] }"),
        _ => {
            let keys: Vec<&str> = keys.iter().copied().chain(flags.iter().map(String::as_str)).collect();
            table.unknown(value, &keys)
        }
    }
}

fn check_flag(
    value: &Value<'_>,
    known: &[String],
    kind: Kind,
    unknown: impl FnOnce() -> CliError,
) -> Result<(), CliError> {
    let name = &value.key;
    if !known.contains(name) {
        Err(unknown())
    } else if kind != Kind::Reference && shot::is_of_reference(name) {
        Err(value.error(format!("`{name}` is of the reference renderer; it is for cases with kind = \"reference\"")))
    } else if is_foreign(name, kind) {
        Err(value.error(format!("a furnace has white surroundings and no other light; leave out `{name}`")))
    } else {
        Ok(())
    }
}

/// The lists of a matrix: for each key what it can be.
fn matrix(value: &Value<'_>, kind: Kind) -> Result<Vec<Vec<Flag>>, CliError> {
    let table = value.table()?;
    let known = shot::names();
    let mut axes = Vec::new();
    for axis in table.rest() {
        if axis.key != "model" {
            let problem = || format!("`{}` in a matrix is neither `model` nor a flag of render", axis.key);
            check_flag(axis, &known, kind, || axis.error(problem()))?;
        }
        let values = axis.array()?.iter().map(Flag::of).collect::<Result<Vec<_>, _>>()?;
        if values.is_empty() {
            return Err(axis.error(format!("`{}` in the matrix is empty, so that there would be no case", axis.key)));
        }
        axes.push(values);
    }
    let count = axes.iter().try_fold(1_usize, |count, axis| count.checked_mul(axis.len()));
    if count.is_none_or(|count| count > MATRIX_MAX) {
        return Err(value.error(format!("the matrix has more than {MATRIX_MAX} cases")));
    }
    Ok(axes)
}

/// One flag of every axis, the last axis fastest.
fn combinations(axes: &[Vec<Flag>]) -> Vec<Vec<&Flag>> {
    let mut combinations = vec![Vec::new()];
    for axis in axes {
        let longer = |head: Vec<_>| axis.iter().map(move |flag| [&head[..], &[flag]].concat());
        combinations = combinations.into_iter().flat_map(longer).collect();
    }
    combinations
}

/// What a matrix adds to the name: `quality=draft,env=white`. A file is called by its name without folder and ending.
fn suffix(combination: &[&Flag]) -> Option<String> {
    let part = |flag: &&Flag| {
        let value = flag.value().unwrap_or("on");
        let is_file = matches!(flag.name.as_str(), "model" | "env");
        let value =
            if is_file { Path::new(value).file_stem().and_then(|s| s.to_str()).unwrap_or(value) } else { value };
        let legal = |c: char| if c.is_ascii_alphanumeric() || "._-+,".contains(c) { c } else { '_' };
        format!("{}={}", flag.name, value.chars().map(legal).collect::<String>())
    };
    (!combination.is_empty()).then(|| combination.iter().map(part).collect::<Vec<_>>().join(","))
}

/// A name is the path of files on any system, and needs no quotes in a shell.
fn check_name(value: &Value<'_>) -> Result<(), CliError> {
    let name = value.string()?;
    let legal = |c: char| c.is_ascii_alphanumeric() || "._-+/".contains(c);
    let part = |part: &str| !part.is_empty() && !part.starts_with(['.', '-']) && !part.ends_with('.');
    if name.len() <= 200 && name.chars().all(legal) && name.split('/').all(part) {
        return Ok(());
    }
    Err(value.error(format!(
        "{name:?} is no name: take letters, digits and . _ - + in parts between /, none of which begins with . or -"
    )))
}

fn kind(value: &Value<'_>) -> Result<Kind, CliError> {
    match value.string()? {
        "golden" => Ok(Kind::Golden),
        "furnace" => Ok(Kind::Furnace),
        "reference" => Ok(Kind::Reference),
        other => Err(value.error(format!("`{other}` is no kind; there are golden, furnace and reference"))),
    }
}

fn within(value: &Value<'_>) -> Result<(f64, String), CliError> {
    let share = value.text().and_then(|text| crate::cli::truth::parse_error(&text).ok());
    let share = share.ok_or_else(|| value.error("`within` has to be a share above 0, such as \"0.5%\""))?;
    Ok((share, value.place()))
}

fn skip(value: &Value<'_>) -> Result<Skip, CliError> {
    let table = value.table()?;
    let required = |key: &str| table.take(key).ok_or_else(|| value.error(format!("`skip` has no `{key}`")));
    let skip = Skip { reason: required("reason")?.string()?.to_owned(), until: required("until")?.date()? };
    table.finish(&["reason", "until"])?;
    if skip.reason.trim().is_empty() {
        return Err(value.error("`skip` has an empty reason"));
    }
    Ok(skip)
}
