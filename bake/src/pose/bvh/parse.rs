//! Text to [`Bvh`], strictly: what is left out or left over is an error with its line.
//!
//! ```text
//! HIERARCHY  ROOT name { OFFSET x y z  CHANNELS n …  (JOINT name { … } | End Site { OFFSET x y z })* }
//! MOTION  Frames: n  Frame Time: s  and n lines with a number a channel
//! ```

use super::{Bvh, Channel, Joint};
use crate::Error;
use glam::DVec3;

/// Most joints; hands and face included, real skeletons have a few hundred.
const MOST_JOINTS: usize = 4096;
/// Largest magnitude of a number: squares and products of such lengths are far from overflow.
const LARGEST: f64 = 1e9;

/// See [`Bvh::from_bytes`].
pub(super) fn parse(name: &str, bytes: &[u8]) -> Result<Bvh, Error> {
    let text = core::str::from_utf8(bytes).map_err(|e| {
        let line = bytes[..e.valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
        Error::unusable(name, format!("line {line}"), "it is not text in UTF-8", "export it as BVH again")
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut words = Words { file: name, line: 0, rest: "", lines: text.lines() };
    let joints = hierarchy(&mut words)?;
    words.expect("MOTION")?;
    let (frames, frame_time) = motion_head(&mut words)?;
    let values = motion(&mut words, frames, channels_of(&joints))?;
    Ok(Bvh { joints, frame_time, values })
}

/// The words of a file, with the line they are on.
struct Words<'a> {
    file: &'a str,
    line: usize,
    /// What is left of the line.
    rest: &'a str,
    lines: core::str::Lines<'a>,
}

impl<'a> Words<'a> {
    fn error(&self, problem: String, remedy: &str) -> Error {
        Error::unusable(self.file, format!("line {}", self.line), problem, remedy)
    }

    /// Goes to the next line that is not empty; whether there is one.
    fn next_line(&mut self) -> bool {
        while self.rest.is_empty() {
            let Some(line) = self.lines.next() else { return false };
            self.line += 1;
            self.rest = line.trim();
        }
        true
    }

    /// The next word; `what` is for the error at the end of the file.
    fn next(&mut self, what: &str) -> Result<&'a str, Error> {
        if !self.next_line() {
            return Err(self.error(format!("the file ends where {what} should be"), "export it again, whole"));
        }
        let end = self.rest.find(char::is_whitespace).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest.trim_start();
        Ok(word)
    }

    fn expect(&mut self, wanted: &str) -> Result<(), Error> {
        let word = self.next(&format!("`{wanted}`"))?;
        if word.eq_ignore_ascii_case(wanted) {
            return Ok(());
        }
        Err(self.error(format!("`{}` where `{wanted}` should be", shown(word)), "export it as BVH again"))
    }

    /// What is left of the line, a `{` at its end left for later: names may hold spaces.
    fn name(&mut self) -> &'a str {
        let name = self.rest.strip_suffix('{').unwrap_or(self.rest);
        self.rest = &self.rest[name.len()..];
        name.trim_end()
    }

    fn number(&mut self, what: &str) -> Result<f64, Error> {
        let word = self.next(what)?;
        self.to_number(word, what)
    }

    fn to_number(&self, word: &str, what: &str) -> Result<f64, Error> {
        match word.parse::<f64>() {
            Ok(x) if x.abs() <= LARGEST => Ok(x),
            Ok(_) => Err(self.error(
                format!("{what} is {}, which is no measure of a body", shown(word)),
                "export it again without numbers beyond a billion",
            )),
            Err(_) => Err(self.error(
                format!("{what} is `{}`, which is no number", shown(word)),
                "write numbers with a point, such as 0.5",
            )),
        }
    }

    fn count(&mut self, what: &str) -> Result<usize, Error> {
        let word = self.next(what)?;
        word.parse().map_err(|_| {
            self.error(format!("{what} is `{}`, which is no count", shown(word)), "export it as BVH again")
        })
    }

    fn vector(&mut self) -> Result<DVec3, Error> {
        self.expect("OFFSET")?;
        Ok(DVec3::new(self.number("the offset")?, self.number("the offset")?, self.number("the offset")?))
    }
}

/// The first characters of a word, for an error of one line.
fn shown(word: &str) -> String {
    word.chars().filter(|c| !c.is_control()).take(40).collect()
}

/// The joints, in the order of the file.
fn hierarchy(words: &mut Words<'_>) -> Result<Vec<Joint>, Error> {
    words.expect("HIERARCHY")?;
    words.expect("ROOT")?;
    let mut joints = vec![joint(words, &[], None)?];
    // Joints whose brace is open; a list and no recursion, so that no depth overflows the stack.
    let mut open = vec![0];
    while let Some(&parent) = open.last() {
        match words.next("`JOINT`, `End Site` or `}`")? {
            "}" => {
                open.pop();
            }
            word if word.eq_ignore_ascii_case("JOINT") => {
                if joints.len() == MOST_JOINTS {
                    let problem = format!("more than {MOST_JOINTS} joints");
                    return Err(words.error(problem, "leave out what is no skeleton"));
                }
                open.push(joints.len());
                let joint = joint(words, &joints, Some(parent))?;
                joints.push(joint);
            }
            word if word.eq_ignore_ascii_case("End") => {
                words.expect("Site")?;
                words.expect("{")?;
                let end = words.vector()?;
                joints[parent].ends.push(end);
                words.expect("}")?;
            }
            word => {
                let problem = format!("`{}` where `JOINT`, `End Site` or `}}` should be", shown(word));
                return Err(words.error(problem, "export it as BVH again"));
            }
        }
    }
    if joints.iter().all(|j| j.channels.is_empty()) {
        return Err(words.error("no joint has a channel".to_owned(), "export it with its motion"));
    }
    Ok(joints)
}

/// A joint from its name to its channels.
fn joint(words: &mut Words<'_>, before: &[Joint], parent: Option<usize>) -> Result<Joint, Error> {
    let name = words.name().to_owned();
    if before.iter().any(|j| j.name == name) {
        let problem = format!("a second joint is called `{}`", shown(&name));
        return Err(words.error(problem, "give every joint a name of its own"));
    }
    if name.is_empty() {
        return Err(words.error("a joint has no name".to_owned(), "give every joint a name of its own"));
    }
    words.expect("{")?;
    let offset = words.vector()?;
    words.expect("CHANNELS")?;
    let count = words.count("the number of channels")?;
    if count > 6 {
        let problem = format!("`{}` has {count} channels", shown(&name));
        return Err(words.error(problem, "a joint has up to three positions and three rotations"));
    }
    let mut channels = Vec::with_capacity(count);
    for _ in 0..count {
        let word = words.next("a channel")?;
        let channel = channel(word).filter(|c| !channels.contains(c)).ok_or_else(|| {
            let problem = format!("`{}` is no channel, or twice there", shown(word));
            words.error(
                problem,
                "channels are Xposition, Yposition, Zposition, Xrotation, Yrotation, Zrotation",
            )
        })?;
        channels.push(channel);
    }
    let first = channels_of(before);
    Ok(Joint { name, parent, offset, ends: Vec::new(), channels, first })
}

/// Numbers in a frame of these joints.
fn channels_of(joints: &[Joint]) -> usize {
    joints.last().map_or(0, |j| j.first + j.channels.len())
}

fn channel(word: &str) -> Option<Channel> {
    let axis = match word.as_bytes().first()?.to_ascii_uppercase() {
        b'X' => 0,
        b'Y' => 1,
        b'Z' => 2,
        _ => return None,
    };
    match word.get(1..)? {
        kind if kind.eq_ignore_ascii_case("position") => Some(Channel::Position(axis)),
        kind if kind.eq_ignore_ascii_case("rotation") => Some(Channel::Rotation(axis)),
        _ => None,
    }
}

/// Number of frames, and the seconds between them.
fn motion_head(words: &mut Words<'_>) -> Result<(usize, f64), Error> {
    words.expect("Frames:")?;
    let frames = words.count("the number of frames")?;
    if frames == 0 {
        return Err(words.error("there are no frames".to_owned(), "export it with its motion"));
    }
    words.expect("Frame")?;
    words.expect("Time:")?;
    let time = words.number("the frame time")?;
    if time <= 0.0 || !words.rest.is_empty() {
        let problem = format!("the frame time is `{time} {}`", shown(words.rest));
        return Err(words.error(problem, "give seconds between frames, above 0, such as 0.00833333"));
    }
    Ok((frames, time))
}

/// The numbers of all frames: grows with what is there, not with what is promised.
fn motion(words: &mut Words<'_>, frames: usize, channels: usize) -> Result<Vec<f64>, Error> {
    let mut values = Vec::new();
    for frame in 0..frames {
        if !words.next_line() {
            let problem = format!("the file ends after {frame} of {frames} frames");
            return Err(words.error(problem, "export it again, whole, or correct `Frames:`"));
        }
        let line = core::mem::take(&mut words.rest);
        let before = values.len();
        for word in line.split_whitespace() {
            values.push(words.to_number(word, "a channel")?);
        }
        let found = values.len() - before;
        if found != channels {
            let problem = format!("frame {frame} has {found} numbers, the skeleton {channels} channels");
            return Err(words.error(problem, "give each frame a line with a number a channel"));
        }
    }
    if words.next_line() {
        let problem = format!("there is more after {frames} frames");
        return Err(words.error(problem, "correct `Frames:`, or cut the file there"));
    }
    Ok(values)
}
