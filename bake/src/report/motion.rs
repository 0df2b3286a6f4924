//! A character's liveliest clip: moving pictures, moments, and how far each region goes.

use super::{Block, COLORS, Image, Picture, Plot, Section, Series};
use crate::film::{Film, Look, SHAKE_ROUND, Survey};
use crate::play::{Frame, Motion, Player, Settings};
use crate::recipe::{Flesh, Region};
use crate::{Error, Model};
use image::{RgbImage, imageops};
use sinew::kernel::spring::{Response, Spring};
use sinew::{Asset, Character};

/// Height of pictures, pixels.
const HEIGHT: u32 = 360;
/// Frames a second of moving pictures, at most.
const GIF_FPS: f32 = 20.0;
/// Clips that are listed.
const CLIP_ROWS: usize = 12;
/// Clips that are tried.
const MOST_CLIPS: usize = 24;
/// Moments of the contact sheet.
const MOMENTS: u32 = 5;
/// Longest run, s: the page is to stay small.
const LONGEST: f32 = 4.0;
/// Lines of a plot.
const LINES: usize = 6;

/// Plays the clips (or the built-in shake) and shows the one that moves flesh most.
pub(super) fn section(model: &Model, flesh: &Flesh, asset: Asset<'_>) -> Result<Section, Error> {
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let tried = tried(model, asset, &mut memory)?;
    // The first among equals.
    let liveliest = tried.iter().fold(None, |best: Option<&Tried>, t| match best {
        Some(best) if best.largest >= t.largest => Some(best),
        _ => Some(t),
    });
    let settings = liveliest.map_or_else(shake, |t| t.settings.clone());
    let mut player = Player::new(model, asset, &mut memory, &settings)?;
    let (name, fps) = (player.motion.name().to_owned(), player.fps);
    let mut survey = Survey::new(model, &player, MOMENTS);
    let mut lines = vec![Vec::new(); flesh.regions.len()];
    while let Some(frame) = player.next()? {
        survey.add(model, frame);
        let peaks = peaks(flesh, frame);
        #[allow(clippy::cast_precision_loss, reason = "a number of frames")]
        let time = f64::from(frame.index as f32 / fps);
        lines.iter_mut().zip(peaks).for_each(|(line, p)| line.push([time, 100.0 * f64::from(p)]));
    }
    let hottest = 100.0 * survey.hottest;
    let film = Film::new(model, survey, HEIGHT);
    let mut player = Player::new(model, asset, &mut memory, &settings)?;
    let mut blocks = vec![Block::Pictures(vec![moving(&film, &mut player)?])];
    blocks.extend(strips(&film, hottest));
    blocks.push(Block::Plot(offsets(flesh, lines)));
    if tried.len() > 1 {
        blocks.extend(clips(tried, model.clips.len()));
    }
    Ok(Section { heading: format!("In motion: {name}"), blocks })
}

/// What playing a clip showed.
struct Tried {
    name: String,
    length: f32,
    largest: f32,
    settings: Settings,
}

/// The clips that move flesh most.
fn clips(mut tried: Vec<Tried>, all: usize) -> Vec<Block> {
    let mut blocks = Vec::new();
    if tried.len() < all {
        blocks.push(Block::Text(format!("Of {all} clips the first {} were tried.", tried.len())));
    }
    tried.sort_by(|a, b| b.largest.total_cmp(&a.largest));
    tried.truncate(CLIP_ROWS);
    let row = |t: &Tried| {
        let cells = [t.name.clone(), format!("{:.2}", t.length), format!("{:.1}", 100.0 * t.largest)];
        (None, cells.into())
    };
    let columns = ["clip", "length, s", "farthest from skinning, % of the body"].map(str::to_owned).into();
    blocks.push(Block::Table { columns, rows: tried.iter().map(row).collect() });
    blocks
}

fn shake() -> Settings {
    Settings { seconds: Some(LONGEST), ..Settings::default() }
}

/// Plays each clip, the first [`MOST_CLIPS`].
fn tried(model: &Model, asset: Asset<'_>, memory: &mut [f32]) -> Result<Vec<Tried>, Error> {
    let mut out = Vec::new();
    for clip in model.clips.iter().take(MOST_CLIPS) {
        let seconds = if clip.duration > 0.0 { clip.duration.min(LONGEST) } else { 1.0 };
        let settings =
            Settings { clip: Some(clip.name.clone()), seconds: Some(seconds), ..Settings::default() };
        let mut player = Player::new(model, asset, memory, &settings)?;
        let mut largest = 0.0_f32;
        while let Some(frame) = player.next()? {
            largest = frame.heat.iter().copied().fold(largest, f32::max);
        }
        out.push(Tried { name: clip.name.clone(), length: clip.duration, largest, settings });
    }
    Ok(out)
}

/// Skinning and sinew side by side, as a GIF.
fn moving(film: &Film<'_>, player: &mut Player<'_>) -> Result<Picture, Error> {
    let looks = [("skinning", Look::Skinning), ("sinew", Look::Flesh)];
    let name = player.motion.name().to_owned();
    if player.motion == Motion::Shake {
        // The second round goes over into itself.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
        let round = (SHAKE_ROUND * player.fps) as u32;
        for _ in round..player.frames {
            player.next()?;
        }
    }
    let gif = film.gif(Vec::new(), player, GIF_FPS, &looks, || ());
    let gif =
        gif.map_err(|e| Error::unusable(name.as_str(), "report", e.to_string(), "leave --report out"))?;
    let [width, height] = film.size();
    let caption = format!("{name}: skinning alone at the left, sinew at the right");
    Ok(Picture { image: Image::Gif(gif, [2 * width, height]), caption })
}

/// The same moments in three looks.
fn strips(film: &Film<'_>, hottest: f32) -> [Block; 3] {
    let moments: Vec<String> = film.moments().iter().map(|f| format!("{:.2}", f.time)).collect();
    [
        (Look::Skinning, format!("Skinning alone, at {} s", moments.join(", "))),
        (Look::Flesh, "sinew at the same moments".to_owned()),
        (
            Look::Heat,
            format!("How far the two are apart: grey not at all, dark purple {hottest:.1} % of the body"),
        ),
    ]
    .map(|(look, caption)| {
        let image = Image::Still(joined(&film.draw_all(film.moments(), &[("", look)])));
        Block::Strip(Picture { image, caption })
    })
}

/// Greatest distance from skinning in each region, body sizes.
fn peaks(flesh: &Flesh, frame: &Frame) -> Vec<f32> {
    let mut peaks = vec![0.0_f32; flesh.regions.len()];
    for ((heat, region), softness) in frame.heat.iter().zip(&flesh.region).zip(&flesh.softness) {
        if let Some(peak) = peaks.get_mut(usize::from(*region)).filter(|_| *softness > 0.0) {
            *peak = peak.max(*heat);
        }
    }
    peaks
}

/// The regions that go farthest.
fn offsets(flesh: &Flesh, lines: Vec<Vec<[f64; 2]>>) -> Plot {
    let top = |line: &[[f64; 2]]| line.iter().map(|p| p[1]).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..lines.len()).collect();
    order.sort_by(|a, b| top(&lines[*b]).total_cmp(&top(&lines[*a])));
    order.truncate(LINES);
    let line = |i: usize| Series {
        name: flesh.regions[i].name.clone(),
        color: i % COLORS,
        points: lines[i].clone(),
    };
    Plot {
        title: "Distance from skinning of the softest place of each region".to_owned(),
        x_label: "time, s".to_owned(),
        y_label: "% of the body".to_owned(),
        series: order.into_iter().map(line).collect(),
    }
}

/// What a region does after a sudden stop, by the runtime's own solution.
pub(super) fn response(regions: &[Region]) -> Plot {
    let line = |(i, r): (usize, &Region)| {
        let spring = Spring::new(r.frequency, r.damping);
        let at = |k: u8| {
            let t = f32::from(k) / 100.0;
            let (y, _) = Response::new(spring, t).apply(1.0, 0.0, 0.0, 0.0);
            [f64::from(t), f64::from(y)]
        };
        Series { name: r.name.clone(), color: i % COLORS, points: (0..=150).map(at).collect() }
    };
    Plot {
        title: "After a sudden stop".to_owned(),
        x_label: "time, s".to_owned(),
        y_label: "share of the offset left".to_owned(),
        series: regions.iter().enumerate().map(line).take(LINES).collect(),
    }
}

/// Pictures of one size in a row.
fn joined(pictures: &[RgbImage]) -> RgbImage {
    let width = pictures.iter().map(RgbImage::width).sum::<u32>().max(1);
    let mut out = RgbImage::new(width, pictures.iter().map(RgbImage::height).max().unwrap_or(1));
    let mut x = 0;
    for picture in pictures {
        imageops::replace(&mut out, picture, x, 0);
        x += i64::from(picture.width());
    }
    out
}
