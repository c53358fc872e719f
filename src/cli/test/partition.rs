//! Which cases of a run are whose, where several processes share it: `--partition hash:2/4`.

use super::report::PartReport;
use crate::cli::error::CliError;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::str::FromStr;

/// How cases are shared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scheme {
    /// Runs of neighbours, equally long: neighbours often share a model, which is then loaded once.
    Slice,
    /// By the hash of the name: a case stays in its part when others come and go.
    Hash,
    /// So that the parts take equally long, by the times of an earlier run.
    Weight,
}

const SCHEMES: [(&str, Scheme); 3] = [("slice", Scheme::Slice), ("hash", Scheme::Hash), ("weight", Scheme::Weight)];

/// As it was asked for; what is not said comes from the scheduler that has started the process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) struct PartitionRequest {
    scheme: Scheme,
    number: Option<usize>,
    of: Option<usize>,
}

impl FromStr for PartitionRequest {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, rest) = text.split_once(':').map_or((text, None), |(name, rest)| (name, Some(rest)));
        let scheme = SCHEMES.into_iter().find(|(known, _)| *known == name).map(|(_, scheme)| scheme);
        let scheme = scheme.ok_or_else(|| format!("{text:?} is no partition; write one such as hash:1/4"))?;
        let Some(rest) = rest else { return Ok(Self { scheme, number: None, of: None }) };
        let (number, of) = rest
            .split_once('/')
            .ok_or_else(|| format!("{rest:?} names no part; write its number and how many there are, such as 1/4"))?;
        let number = if number == "auto" { None } else { Some(count(number)?) };
        let of = count(of)?;
        if number.is_some_and(|number| number > of) {
            return Err(format!("there is no part {rest}; they are numbered from 1/{of} to {of}/{of}"));
        }
        Ok(Self { scheme, number, of: Some(of) })
    }
}

/// Beyond all arrays of all schedulers.
const MOST_PARTS: usize = 1_000_000;

fn count(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|number| (1..=MOST_PARTS).contains(number));
    number.ok_or_else(|| format!("{text:?} is no number from 1 to {MOST_PARTS}"))
}

/// What schedulers say in environment variables about a process.
struct Scheduler {
    /// Number of the process.
    index: &'static str,
    /// What the first one has.
    first: usize,
    /// How many there are, as far as the scheduler says it.
    total: &'static str,
}

const SCHEDULERS: [Scheduler; 3] = [
    // The largest number of the array; how many tasks there are differs from it when one is repeated alone.
    Scheduler { index: "SLURM_ARRAY_TASK_ID", first: 1, total: "SLURM_ARRAY_TASK_MAX" },
    // Kubernetes itself does not tell the total: the recipe sets it.
    Scheduler { index: "JOB_COMPLETION_INDEX", first: 0, total: "JOB_COMPLETIONS" },
    Scheduler { index: "CI_NODE_INDEX", first: 1, total: "CI_NODE_TOTAL" },
];

impl Scheduler {
    /// Number and total of this process, both from 1.
    fn place(&self, variable: impl Fn(&str) -> Option<String>) -> Result<Option<(usize, Option<usize>)>, String> {
        let number = |name: &str| {
            let text = variable(name);
            let parsed = text.map(|text| text.parse::<usize>().map_err(|_| format!("{name} is {text:?}, no number")));
            parsed.transpose()
        };
        let Some(index) = number(self.index)? else { return Ok(None) };
        let Some(from_zero) = index.checked_sub(self.first) else {
            return Err(format!("{} is {index}; number the parts from {}", self.index, self.first));
        };
        Ok(Some((from_zero + 1, self.total(number(self.total)?, number)?)))
    }

    fn total(
        &self,
        total: Option<usize>,
        number: impl Fn(&str) -> Result<Option<usize>, String>,
    ) -> Result<Option<usize>, String> {
        if self.index == "SLURM_ARRAY_TASK_ID" && number("SLURM_ARRAY_TASK_COUNT")? != total {
            // An array with gaps, or one task that is repeated: its largest number says nothing.
            return Ok(None);
        }
        Ok(total)
    }
}

/// A part of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) struct Partition {
    scheme: Scheme,
    number: usize,
    of: usize,
}

/// What is shared.
#[derive(Debug, Clone, Copy)]
pub(in crate::cli) struct Share<'a> {
    pub(in crate::cli) id: &'a str,
    /// How long it took in an earlier run, as far as known.
    pub(in crate::cli) milliseconds: Option<f64>,
}

impl PartitionRequest {
    /// Whether the times of an earlier run matter.
    pub(in crate::cli) fn is_by_weight(&self) -> bool {
        self.scheme == Scheme::Weight
    }

    /// The part of this process.
    ///
    /// # Errors
    /// Where neither the request nor one scheduler says which part this is, and of how many.
    pub(super) fn resolve(&self, variable: impl Fn(&str) -> Option<String>) -> Result<Partition, CliError> {
        self.place(variable).map_err(|reason| CliError::Usage(format!("--partition: {reason}")))
    }

    /// The same by the environment of this process.
    ///
    /// # Errors
    /// As [`Self::resolve`].
    pub(in crate::cli) fn resolve_here(&self) -> Result<Partition, CliError> {
        self.resolve(|name| std::env::var(name).ok().filter(|value| !value.is_empty()))
    }

    fn place(&self, variable: impl Fn(&str) -> Option<String>) -> Result<Partition, String> {
        let scheme = self.scheme;
        if let (Some(number), Some(of)) = (self.number, self.of) {
            return Ok(Partition { scheme, number, of });
        }
        let mut found = Vec::new();
        for scheduler in &SCHEDULERS {
            found.extend(scheduler.place(&variable)?.map(|place| (scheduler, place)));
        }
        let names = |schedulers: &mut dyn Iterator<Item = &Scheduler>, between: &str| {
            schedulers.map(|scheduler| scheduler.index).collect::<Vec<_>>().join(between)
        };
        match found[..] {
            [(scheduler, (number, total))] => {
                let of = self.of.or(total).ok_or_else(|| {
                    format!("{} does not say how many parts there are; write auto/N", scheduler.index)
                })?;
                if number > of {
                    return Err(format!("{} makes this part {number} of {of}", scheduler.index));
                }
                Ok(Partition { scheme, number, of })
            }
            [] => Err(format!("none of {} is set; write K/N", names(&mut SCHEDULERS.iter(), ", "))),
            _ => {
                let set = names(&mut found.iter().map(|(scheduler, _)| *scheduler), " and ");
                Err(format!("{set} are set; write K/N"))
            }
        }
    }
}

impl Partition {
    /// Indices of the cases of this part, ascending. Each case is in one part, whatever the other parts do: all have to be
    /// given the same cases and times.
    pub(in crate::cli) fn select(&self, cases: &[Share<'_>]) -> Vec<usize> {
        let (part, of) = (self.number - 1, self.of);
        match self.scheme {
            Scheme::Slice => (cases.len() * part / of..cases.len() * (part + 1) / of).collect(),
            Scheme::Hash => (0..cases.len()).filter(|&i| hashed(cases[i].id, of) == part).collect(),
            Scheme::Weight => {
                let parts = balanced(cases, of);
                (0..cases.len()).filter(|&i| parts[i] == part).collect()
            }
        }
    }

    /// `cases` are those of all parts.
    pub(super) fn report(&self, cases: usize) -> PartReport {
        let scheme = SCHEMES.into_iter().find(|(_, scheme)| *scheme == self.scheme).map_or("", |(name, _)| name);
        PartReport { scheme: scheme.into(), number: self.number, of: self.of, cases }
    }
}

/// Part of a name, from 0.
fn hashed(id: &str, of: usize) -> usize {
    let mut start = [0; 8];
    start.copy_from_slice(&blake3::hash(id.as_bytes()).as_bytes()[..8]);
    (u64::from_le_bytes(start) % of as u64) as usize
}

/// Part of each case, from 0: the longest first, each to the part that has least (Graham 1969: at most 4/3 of the best).
/// Cases of unknown length count as the mean of the others.
fn balanced(cases: &[Share<'_>], of: usize) -> Vec<usize> {
    // Whole microseconds add up alike in any order.
    let microseconds = |ms: f64| (ms.clamp(0.0, 1e9) * 1e3).round() as u64;
    let known: Vec<u64> = cases.iter().filter_map(|case| case.milliseconds).map(microseconds).collect();
    let mean = known.iter().sum::<u64>().checked_div(known.len() as u64).unwrap_or(1).max(1);
    let weights: Vec<u64> = cases.iter().map(|case| case.milliseconds.map_or(mean, microseconds)).collect();
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by_key(|&i| (Reverse(weights[i]), cases[i].id));
    // Parts beyond the number of cases get none.
    let mut loads: BinaryHeap<Reverse<(u64, usize)>> =
        (0..of.min(cases.len())).map(|part| Reverse((0, part))).collect();
    let mut parts = vec![0; cases.len()];
    for i in order {
        // There are as many loads as cases, or one for each part.
        if let Some(mut lightest) = loads.peek_mut() {
            parts[i] = lightest.0.1;
            lightest.0.0 += weights[i];
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(text: &str) -> PartitionRequest {
        text.parse().unwrap()
    }

    fn within(text: &str, variables: &[(&str, &str)]) -> Result<Partition, String> {
        let lookup = |name: &str| variables.iter().find(|(n, _)| *n == name).map(|(_, value)| (*value).to_owned());
        request(text).resolve(lookup).map_err(|error| error.to_string())
    }

    /// What each part takes of cases that take some milliseconds.
    fn parts(scheme: &str, of: usize, milliseconds: &[Option<f64>]) -> Vec<Vec<usize>> {
        let ids: Vec<String> = (0..milliseconds.len()).map(|i| format!("case-{i}")).collect();
        let cases = ids.iter().zip(milliseconds).map(|(id, &milliseconds)| Share { id, milliseconds });
        let cases: Vec<Share<'_>> = cases.collect();
        let part = |number: usize| within(&format!("{scheme}:{number}/{of}"), &[]).unwrap().select(&cases);
        (1..=of).map(part).collect()
    }

    #[test]
    fn each_case_is_in_one_part() {
        for scheme in ["slice", "hash", "weight"] {
            for (cases, of) in [(0, 3), (1, 1), (2, 5), (30, 4), (31, 7)] {
                let times: Vec<Option<f64>> = (0..cases).map(|i| (i % 3 > 0).then_some(i as f64)).collect();
                let parts = parts(scheme, of, &times);
                assert!(parts.iter().all(|part| part.is_sorted()), "{scheme} {parts:?}");
                let mut all = parts.concat();
                all.sort_unstable();
                assert_eq!(all, (0..cases).collect::<Vec<_>>(), "{scheme}, {of} parts");
            }
        }
    }

    #[test]
    fn slices_are_neighbours_and_hashes_stay() {
        assert_eq!(parts("slice", 3, &[None; 8]), [vec![0, 1], vec![2, 3, 4], vec![5, 6, 7]]);
        // A further case leaves the others where they are.
        let (few, more) = (parts("hash", 3, &[None; 3000]), parts("hash", 3, &[None; 3001]));
        for (few, more) in few.iter().zip(&more) {
            assert!(more.starts_with(few));
            // A thousand, but for what chance does: a standard deviation of 26.
            assert!(few.len().abs_diff(1000) < 100, "{}", few.len());
        }
    }

    #[test]
    fn weights_make_parts_equally_long() {
        let times = [9.0, 1.0, 1.0, 4.0, 5.0, 1.0, 1.0, 8.0].map(Some);
        for part in parts("weight", 3, &times) {
            let load: f64 = part.iter().map(|&i| times[i].unwrap()).sum();
            assert_eq!(load, 10.0, "{part:?}");
        }
        // Of what is not known the mean is assumed: 3, 1 and twice 2.
        assert_eq!(parts("weight", 2, &[Some(3.0), Some(1.0), None, None]), [[0, 1], [2, 3]]);
    }

    #[test]
    fn schedulers_say_which_part_it_is() {
        let slurm = |id, max, count| {
            [("SLURM_ARRAY_TASK_ID", id), ("SLURM_ARRAY_TASK_MAX", max), ("SLURM_ARRAY_TASK_COUNT", count)]
        };
        let place = |number, of| Ok(Partition { scheme: Scheme::Hash, number, of });
        assert_eq!(within("hash", &slurm("3", "4", "4")), place(3, 4));
        // One task of an array, run again.
        assert_eq!(within("hash:auto/4", &slurm("3", "3", "1")), place(3, 4));
        assert!(within("hash", &slurm("3", "3", "1")).unwrap_err().contains("auto/N"));
        assert!(within("hash", &slurm("0", "3", "4")).unwrap_err().contains("number the parts from 1"));
        assert!(within("hash:auto/4", &slurm("5", "5", "5")).unwrap_err().contains("5 of 4"));

        assert_eq!(within("hash:auto/4", &[("JOB_COMPLETION_INDEX", "0")]), place(1, 4));
        assert_eq!(within("hash", &[("JOB_COMPLETION_INDEX", "3"), ("JOB_COMPLETIONS", "4")]), place(4, 4));
        assert!(within("hash", &[("JOB_COMPLETION_INDEX", "0")]).unwrap_err().contains("auto/N"));
        assert_eq!(within("hash", &[("CI_NODE_INDEX", "2"), ("CI_NODE_TOTAL", "2")]), place(2, 2));
        assert!(within("hash", &[("CI_NODE_INDEX", "two")]).unwrap_err().contains("no number"));

        assert!(within("hash", &[]).unwrap_err().contains("write K/N"));
        let both = [("CI_NODE_INDEX", "1"), ("CI_NODE_TOTAL", "2"), ("JOB_COMPLETION_INDEX", "1")];
        assert!(within("hash", &both).unwrap_err().contains("JOB_COMPLETION_INDEX and CI_NODE_INDEX are set"));
        assert_eq!(within("hash:1/2", &both), place(1, 2), "what is said needs no scheduler");
    }

    #[test]
    fn what_is_no_partition_is_refused() {
        for text in ["", "half", "hash:", "hash:1", "hash:0/2", "hash:3/2", "hash:1/0", "slice:auto/auto", "slice:-1/2"]
        {
            let error = PartitionRequest::from_str(text).unwrap_err();
            assert!(!error.is_empty() && !error.contains('\n'), "{text}: {error}");
        }
        assert!(request("weight").is_by_weight() && !request("slice:1/2").is_by_weight());
        let report = within("weight:2/3", &[]).unwrap().report(9);
        assert_eq!((report.scheme.as_str(), report.number, report.of, report.cases), ("weight", 2, 3, 9));
    }
}
