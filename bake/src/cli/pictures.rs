//! Contact sheets and GIFs of a run.

use super::play::{Arguments, Run, Summary, every};
use super::progress;
use sinew_bake::film::{Film, Look, Survey};
use sinew_bake::play::{Frame, Player};
use sinew_bake::render::{GifWriter, gif_stride, write_png};
use sinew_bake::{Error, Model, export};
use std::io;
use std::path::Path;

/// Columns of a contact sheet.
const COLUMNS: u32 = 6;
/// Frames of a GIF that are drawn at a time, on all threads.
const BATCH: usize = 16;

/// Writes the contact sheet: skinning, sinew, heat map.
pub(super) fn sheet(arguments: &Arguments, run: &mut Run<'_>) -> Result<Summary, Error> {
    let looks = [("skinning", Look::Skinning), ("sinew", Look::Flesh), ("distance", Look::Heat)];
    let looks = if arguments.no_flesh { &looks[..1] } else { &looks[..] };
    let note = run.player()?.describe();
    let (film, summary) = survey(arguments, run)?;
    let bar = progress::bar("draw", looks.len() as u64);
    let page = film.sheet(&note, looks, || bar.inc(1));
    bar.finish_and_clear();
    write_png(&arguments.out, &page)?;
    Ok(summary)
}

/// Writes the GIF: skinning and sinew side by side, or one of them.
pub(super) fn gif(arguments: &Arguments, run: &mut Run<'_>) -> Result<Summary, Error> {
    let looks = [("skinning", Look::Skinning), ("sinew", Look::Flesh)];
    let looks = match (arguments.no_flesh, arguments.alone) {
        (true, _) => &looks[..1],
        (false, true) => &looks[1..],
        (false, false) => &looks[..],
    };
    let (film, summary) = survey(arguments, run)?;
    let samples = film.draw_all(film.moments(), looks);
    let mut player = run.player()?;
    let stride = gif_stride(player.fps);
    #[allow(clippy::cast_precision_loss, reason = "a small number")]
    let fps = player.fps / stride as f32;
    export::write_atomic(&arguments.out, |file| {
        let mut gif = GifWriter::new(file, &samples, fps)?;
        let mut batch = Vec::with_capacity(BATCH);
        let mut draw = |batch: &mut Vec<Frame>| -> Result<(), Error> {
            let pictures = film.draw_all(batch, looks);
            batch.clear();
            pictures.iter().try_for_each(|p| gif.push(p)).map_err(|e| unwritten(&arguments.out, e))
        };
        let all = every("draw", &mut player, |frame| {
            if frame.index % stride == 0 {
                batch.push(frame.clone());
            }
            if batch.len() == BATCH { draw(&mut batch) } else { Ok(()) }
        });
        all.and_then(|_| draw(&mut batch)).map_err(io::Error::other)?;
        gif.finish().map(drop)
    })?;
    Ok(summary)
}

pub(super) fn unwritten(path: &Path, source: io::Error) -> Error {
    Error::Write { path: path.to_owned(), source }
}

/// Plays the run once to find out where the camera has to stand.
fn survey<'a>(arguments: &Arguments, run: &mut Run<'a>) -> Result<(Film<'a>, Summary), Error> {
    let model: &'a Model = run.model;
    let mut player: Player<'_> = run.player()?;
    let mut survey = Survey::new(&player, COLUMNS);
    let summary = every("play", &mut player, |frame| {
        survey.add(model, frame);
        Ok(())
    })?;
    Ok((Film::new(model, survey, u32::from(arguments.height)), summary))
}
