//! Contact sheets and GIFs of a run.

use super::play::{Arguments, Run, Summary, every};
use super::progress;
use sinew_bake::film::{Film, Look, Survey};
use sinew_bake::play::Player;
use sinew_bake::render::{MAX_GIF_FPS, write_png};
use sinew_bake::{Error, Model, export};

/// Columns of a contact sheet.
const COLUMNS: u32 = 6;

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
    let mut player = run.player()?;
    let bar = progress::bar("draw", u64::from(player.frames));
    export::write_atomic(&arguments.out, |file| {
        film.gif(file, &mut player, MAX_GIF_FPS, looks, || bar.inc(1)).map(drop)
    })?;
    bar.finish_and_clear();
    Ok(summary)
}

/// Plays the run once to find out where the camera has to stand.
fn survey<'a>(arguments: &Arguments, run: &mut Run<'a>) -> Result<(Film<'a>, Summary), Error> {
    let model: &'a Model = run.model;
    let mut player: Player<'_> = run.player()?;
    let mut survey = Survey::new(model, &player, COLUMNS);
    let summary = every("play", &mut player, |frame| {
        survey.add(model, frame);
        Ok(())
    })?;
    Ok((Film::new(model, survey, u32::from(arguments.height)), summary))
}
