//! The description of tables of keys: what a struct of the case or study file declares by
//! `#[derive(Keys)]`. The reader, the schema and the documentation use the same descriptions.

mod schemes;
mod value;
mod view;

pub use carom_keys::Keys;
pub use schemes::schemes;
pub(crate) use value::word;
pub use view::{Keys, Value, View};

pub use crate::tree::{Node, Table as Given};

/// A table of the case file: its keys, and those planned for later versions.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// Name of the table in messages: `[[body]]`.
    pub name: &'static str,
    /// Meaning of the table.
    pub doc: &'static str,
    /// Keys of the table, in the order of the documentation.
    pub keys: &'static [Key],
    /// Keys planned for a later version.
    pub later: &'static [&'static str],
    /// Dimension of the cases that may have the table; none if all may.
    pub dimension: Option<usize>,
}

/// A key of a table: its values, default and meaning.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name in the file.
    pub name: &'static str,
    /// Kind of value that the key takes.
    pub kind: Kind,
    /// Physical unit, in the case's own labels; empty if none.
    pub unit: &'static str,
    /// Whether the key is required, and its default value.
    pub default: Default,
    /// Default under `preset = "paper"`, as TOML, where it differs.
    pub paper: Option<&'static str>,
    /// Meaning of the key.
    pub doc: &'static str,
    /// An example value, as TOML.
    pub example: &'static str,
    /// Other kinds of value planned for a later version: a table, a string.
    pub later: &'static str,
    /// Name of a key that replaces this one: where it is given, this one must not be; empty if
    /// none.
    pub unless: &'static str,
}

/// Default value of a key that is not given.
#[derive(Clone, Copy, Debug)]
pub enum Default {
    /// None: the key must be given.
    Required,
    /// There is no default value, or a computed one (stated in the documentation).
    Absent,
    /// This TOML value is the default.
    Is(&'static str),
}

/// Values a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Any string.
    Text,
    /// A name: no dots, blanks, slashes, commas or quotes, because names of columns and sides
    /// contain it.
    Name,
    /// A word from a list.
    Choice(Words),
    /// A finite number in a range.
    Number(Range),
    /// A finite number in a range, or `false`.
    NumberOrFalse(Range),
    /// `true` or `false`.
    Truth,
    /// An integer ≥ the given one.
    Count(usize),
    /// Integers ≥ the given one: one in dimension 1, a list with one per direction in dimensions 2
    /// and 3.
    Counts(usize),
    /// A vector: one finite number per dimension.
    Vector,
    /// `"x"`, `"y"` or `"z"`, or one number per dimension.
    Direction,
    /// Any number of finite numbers in a range.
    Numbers(Range),
    /// At least this many points of the plane.
    Points(usize),
    /// A finite number, or a formula in these variables (`Y` and `Z` where they exist).
    Formula(&'static [&'static str]),
    /// A vector of numbers or formulas in these variables, one per dimension.
    Formulas(&'static [&'static str]),
    /// A vector of numbers or formulas in these variables, one per dimension; or this table.
    FormulasOr(&'static [&'static str], &'static Table),
    /// A table of formulas in t, with names of columns as keys.
    ByColumn,
    /// A table with at least one name, by the name of a physical group.
    NamesByGroup,
    /// A list of at least one of these words.
    Choices(&'static [&'static str]),
    /// A side `body.side`.
    Side,
    /// A list of sides, at least one.
    Sides,
    /// `"all"`, or a list of bodies and sides, at least one.
    Between,
    /// A side, or this table.
    SideOr(&'static Table),
    /// A number in dimensions 1 and 2, one number per direction in space.
    Angular,
    /// A number in dimensions 1 and 2, in space this table.
    Rotation(&'static Table),
    /// A table.
    Table(&'static Table),
    /// Any number of tables, `[[name]]`.
    Tables(&'static Table),
    /// A table with values of the case by key, in a study.
    Changes,
    /// A list of tables with values of the case by key, in a study.
    ChangeLists,
    /// A table with lists of values of the case by key, in a study.
    Grid,
    /// A table whose keys depend on the value of one of them.
    Variant(fn() -> &'static Variants),
}

/// Words of which one is chosen.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// The words, as written in files.
    pub now: &'static [&'static str],
    /// Meanings of the words, in the same order; empty if the key explains them.
    pub meanings: &'static [&'static str],
    /// Words planned for a later version.
    pub later: &'static [&'static str],
}

impl Words {
    /// Words that need no explanation.
    pub const fn plain(now: &'static [&'static str]) -> Self {
        Self { now, meanings: &[], later: &[] }
    }
}

/// Tables distinguished by the value of the key `tag`.
#[derive(Clone, Copy, Debug)]
pub struct Variants {
    /// Name in messages.
    pub name: &'static str,
    /// The key whose value selects the table.
    pub tag: &'static str,
    /// Meaning of the tag.
    pub doc: &'static str,
    /// Values of the tag, each with its table.
    pub tables: &'static [(&'static str, Table)],
    /// A table without the tag, recognised by its first key.
    pub or: Option<&'static Table>,
    /// Dimension of the vectors in these tables; none if it is that of the case.
    pub dimension: Option<usize>,
}

/// An interval of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Lower end, and whether it is included.
    pub low: Option<(f64, bool)>,
    /// Upper end, and whether it is included.
    pub high: Option<(f64, bool)>,
}

/// All finite numbers.
pub const ANY: Range = Range { low: None, high: None };
/// x > 0.
pub const POSITIVE: Range = Range { low: Some((0.0, false)), high: None };
/// x ≥ 0.
pub const NOT_NEGATIVE: Range = Range { low: Some((0.0, true)), high: None };

impl Range {
    /// Whether a number lies inside.
    pub fn contains(&self, x: f64) -> bool {
        self.low.is_none_or(|(low, closed)| x > low || closed && x == low)
            && self.high.is_none_or(|(high, closed)| x < high || closed && x == high)
    }

    /// A valid number near the invalid number `x`: the end of the range that it exceeds, or, if
    /// that end is excluded, a number inside a range of finite width.
    pub fn value_next_to(&self, x: f64) -> Option<f64> {
        let inwards = match (self.low, self.high) {
            (Some((low, _)), Some((high, _))) => Some(0.01 * (high - low).min(1.0)),
            _ => None,
        };
        let value = |(end, closed): (f64, bool), sign: f64| {
            let near = |inwards: f64| ((end + sign * inwards) * 1e6).round() / 1e6;
            if closed { Some(end) } else { inwards.map(near) }
        };
        match (self.low, self.high) {
            (_, Some(high)) if x >= high.0 => value(high, -1.0),
            (Some(low), _) if x <= low.0 => value(low, 1.0),
            _ => None,
        }
    }

    /// Description of the range for messages: `a number > 0`, `a number in [0, 1]`.
    pub fn described(&self) -> String {
        match (self.low, self.high) {
            (None, None) => "a finite number".to_owned(),
            (Some((low, closed)), None) => format!("a number {} {low}", if closed { "≥" } else { ">" }),
            (None, Some((high, closed))) => format!("a number {} {high}", if closed { "≤" } else { "<" }),
            (Some((low, left)), Some((high, right))) => {
                let left = if left { '[' } else { '(' };
                let right = if right { ']' } else { ')' };
                format!("a number in {left}{low}, {high}{right}")
            }
        }
    }
}

/// Variables of formulas in reference position and time.
pub const IN_SPACE_AND_TIME: &[&str] = &["X", "Y", "Z", "t"];
/// Variables of formulas in time.
pub const IN_TIME: &[&str] = &["t"];
/// Variables of formulas in reference position.
pub const IN_SPACE: &[&str] = &["X", "Y", "Z"];

/// The variables of a formula in a space of this dimension: `Y` in the plane, `Z` in space.
pub fn variables(all: &'static [&'static str], dimension: usize) -> Vec<&'static str> {
    let exists = |name: &&str| !["Y", "Z"][dimension.clamp(1, 3) - 1..].contains(name);
    all.iter().copied().filter(exists).collect()
}

impl Table {
    /// A key by name.
    pub fn key(&self, name: &str) -> Option<&Key> {
        self.keys.iter().find(|k| k.name == name)
    }
}

impl Variants {
    /// The table that belongs to a value of the tag.
    pub fn table(&self, tag: &str) -> Option<&Table> {
        self.tables.iter().find(|(value, _)| *value == tag).map(|(_, table)| table)
    }

    /// Whether a table is of the variant without the tag.
    pub fn has_other(&self, table: &Given) -> bool {
        self.or.and_then(|or| or.keys.first()).is_some_and(|key| table.get(key.name).is_some())
    }

    /// The description of a table; none if its tag is missing or unknown.
    pub fn of(&self, table: &Given) -> Option<&Table> {
        match self.or.filter(|_| self.has_other(table)) {
            Some(or) => Some(or),
            None => self.table(table.get(self.tag)?.text()?),
        }
    }
}

impl Kind {
    /// Description of an admissible value, for messages.
    pub fn described(&self, dimension: Option<usize>) -> String {
        let several = |n: Option<usize>| {
            n.map_or_else(
                || "one number per dimension".into(),
                |n| format!("a list of {n} number{}", if n == 1 { "" } else { "s" }),
            )
        };
        let words = |words: &[&str]| words.iter().map(|w| format!("\"{w}\"")).collect::<Vec<_>>().join(", ");
        match self {
            Self::Text => "a string in quotes".into(),
            Self::Name => "a name in quotes".into(),
            Self::Choice(choices) => format!("one of {}", words(choices.now)),
            Self::Number(range) => range.described(),
            Self::NumberOrFalse(range) => format!("{}, or false", range.described()),
            Self::Truth => "true or false".into(),
            Self::Count(least) => format!("a whole number ≥ {least}"),
            Self::Counts(least) if dimension == Some(1) => format!("a whole number ≥ {least}"),
            Self::Counts(least) => format!("a list of {} whole numbers ≥ {least}", dimension.unwrap_or(2)),
            Self::Vector => several(dimension),
            Self::Direction => format!("\"x\", \"y\" or \"z\", or {}", several(dimension)),
            Self::Numbers(_) => "a list of numbers".into(),
            Self::Points(least) => format!("a list of at least {least} points [x, y]"),
            Self::Formula(_) => "a number or a formula in quotes".into(),
            Self::Formulas(_) => format!("{} or formulas in quotes", several(dimension)),
            Self::FormulasOr(..) => format!("{} or formulas in quotes, or a table", several(dimension)),
            Self::ByColumn => "a table of formulas by column".into(),
            Self::NamesByGroup => "a table with a name for each physical group".into(),
            Self::Choices(choices) => format!("a list of values from {}", words(choices)),
            Self::Side => "a side \"body.side\"".into(),
            Self::Between => "\"all\", or a list of bodies and sides [\"body\", \"body.side\"]".into(),
            Self::Sides => "a list of sides [\"body.side\"]".into(),
            Self::SideOr(_) => {
                "a side \"body.side\" or a rigid obstacle { plane = …, circle = …, sphere = …, cylinder = …, polyline = … or surface = … }".into()
            }
            Self::Angular if dimension == Some(3) => several(dimension),
            Self::Rotation(_) if dimension == Some(3) => "a table { axis = [x, y, z], angle = … }".into(),
            Self::Angular | Self::Rotation(_) => "a finite number".into(),
            Self::Table(_) => "a table { key = value }".into(),
            Self::Tables(table) => format!("a list of tables {}", table.name),
            Self::Changes => "a table of values of the case".into(),
            Self::ChangeLists => "a list of tables of values of the case".into(),
            Self::Grid => "a table of lists of values of the case".into(),
            Self::Variant(variants) => format!("a table {{ {} = \"…\", … }}", variants().tag),
        }
    }
}

impl Key {
    /// A required key with all other properties empty, as a base for others.
    pub const NONE: Self = Self {
        name: "",
        kind: Kind::Text,
        unit: "",
        default: Default::Required,
        paper: None,
        doc: "",
        example: "",
        later: "",
        unless: "",
    };

    /// Meaning of the key, followed by the meanings of its words and its unit.
    pub(crate) fn meaning(&self) -> String {
        let mut meaning = vec![self.doc.to_owned()];
        if let Kind::Choice(words) = self.kind {
            let says = words.now.iter().zip(words.meanings);
            meaning.extend(says.map(|(word, says)| format!("{word}: {says}")));
        }
        if !self.unit.is_empty() {
            meaning.push(format!("Unit: {}.", self.unit));
        }
        meaning.join(" ")
    }
}

/// Total number of keys in groups.
pub const fn count(groups: &[&[Key]]) -> usize {
    let mut count = 0;
    let mut group = 0;
    while group < groups.len() {
        count += groups[group].len();
        group += 1;
    }
    count
}

/// Keys of all groups in one array; `N` is their total number.
pub const fn joined<const N: usize>(groups: &[&[Key]]) -> [Key; N] {
    let mut all = [Key::NONE; N];
    let mut next = 0;
    let mut group = 0;
    while group < groups.len() {
        let mut key = 0;
        while key < groups[group].len() {
            all[next] = groups[group][key];
            next += 1;
            key += 1;
        }
        group += 1;
    }
    all
}
