//! A character's first clip: moving pictures, a contact sheet, and how far each region goes.

use super::{Block, COLORS, Image, Picture, Plot, Section, Series};
use crate::film::{Film, Look, Survey};
use crate::play::{Frame, Player, Settings};
use crate::recipe::{Flesh, Region};
use crate::{Error, Model};
use image::{RgbImage, imageops};
use sinew::kernel::spring::{Response, Spring};
use sinew::{Asset, Character};

/// Height of pictures, pixels.
const HEIGHT: u32 = 300;
/// Moments of the contact sheet.
const MOMENTS: u32 = 5;
/// Longest run, s: the page is to stay small.
const LONGEST: f32 = 4.0;
/// Lines of a plot.
const LINES: usize = 6;

/// Plays the first clip (or the built-in shake) and shows it.
pub(super) fn section(model: &Model, flesh: &Flesh, asset: Asset<'_>) -> Result<Section, Error> {
    let round = model.clips.first().map(|c| c.duration).filter(|d| *d > 0.1);
    let settings = Settings { seconds: Some(round.unwrap_or(LONGEST).min(LONGEST)), ..Settings::default() };
    let mut memory = vec![0.0; Character::required_len(&asset)];
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
    let looks = [("skinning", Look::Skinning), ("sinew", Look::Flesh)];
    let gif = film
        .gif(Vec::new(), &mut Player::new(model, asset, &mut memory, &settings)?, &looks, || ())
        .map_err(|e| Error::unusable(model.name.as_str(), "report", e.to_string(), "leave --report out"))?;
    let [width, height] = film.size();
    let strip = |look: Look, caption: String| {
        Block::Strip(Picture {
            image: Image::Still(joined(&film.draw_all(film.moments(), &[("", look)]))),
            caption,
        })
    };
    let moments: Vec<String> = film.moments().iter().map(|f| format!("{:.2}", f.time)).collect();
    let at = format!("at {} s", moments.join(", "));
    let blocks = vec![
        Block::Pictures(vec![Picture {
            image: Image::Gif(gif, [2 * width, height]),
            caption: format!("{name}: skinning alone at the left, sinew at the right"),
        }]),
        strip(Look::Skinning, format!("Skinning alone, {at}")),
        strip(Look::Flesh, "sinew at the same moments".to_owned()),
        strip(
            Look::Heat,
            format!("How far the two are apart: grey not at all, dark purple {hottest:.1} % of the body"),
        ),
        Block::Plot(offsets(flesh, lines)),
    ];
    Ok(Section { heading: format!("In motion: {name}"), blocks })
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
