//! Contact sheets and GIFs: whole, of the promised size and time, with everything in the picture.

use crate::support::Folder;
use image::RgbImage;

fn png(folder: &Folder, name: &str) -> RgbImage {
    image::load_from_memory(&folder.read(name)).expect("a picture").to_rgb8()
}

/// The frames of a GIF as they are shown, and how long each is, hundredths of a second.
fn frames(bytes: &[u8]) -> (Vec<RgbImage>, Vec<u16>, gif::Repeat) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).expect("a GIF");
    let (width, height) = (u32::from(decoder.width()), u32::from(decoder.height()));
    let mut shown = RgbImage::new(width, height);
    let (mut all, mut delays) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        for (i, pixel) in (0_u32..).zip(frame.buffer.chunks_exact(4)) {
            let (x, y) = (i % u32::from(frame.width), i / u32::from(frame.width));
            if pixel[3] == 255 {
                let at = (x + u32::from(frame.left), y + u32::from(frame.top));
                shown.put_pixel(at.0, at.1, image::Rgb([pixel[0], pixel[1], pixel[2]]));
            }
        }
        all.push(shown.clone());
        delays.push(frame.delay);
    }
    (all, delays, decoder.repeat())
}

#[test]
fn a_gif_has_the_frames_the_time_and_the_loop_that_are_promised() {
    let folder = Folder::new("gif");
    if !folder.fox() {
        return;
    }
    for (fps, count) in [(24, 24), (30, 30), (50, 50), (60, 30), (120, 40)] {
        folder.good(&format!("play fox.glb --clip Run --seconds 1 --fps {fps} --height 64 -o a.gif"));
        let (all, delays, repeat) = frames(&folder.read("a.gif"));
        let time: u16 = delays.iter().sum();
        assert_eq!((all.len(), time, repeat), (count, 100, gif::Repeat::Infinite), "at {fps} Hz");
        assert!(delays.iter().all(|d| (2..=5).contains(d)), "even: {delays:?}");
        assert_eq!(all[0].height(), 64);
        assert!(all.windows(2).all(|w| w[0] != w[1]), "every frame moves");
    }
}

#[test]
fn skinning_stands_beside_sinew_unless_one_is_asked_for() {
    let folder = Folder::new("beside");
    if !folder.fox() {
        return;
    }
    let gif = |more: &str| {
        folder.good(&format!("play fox.glb --clip Run --seconds 0.2 --height 96 -o a.gif{more}"));
        frames(&folder.read("a.gif")).0
    };
    let (both, alone, bare) = (gif(""), gif(" --alone"), gif(" --no-flesh"));
    assert_eq!(both[0].width(), 2 * alone[0].width());
    assert_eq!(alone[0].width(), bare[0].width());
    let far = |a: &RgbImage, b: &RgbImage| {
        a.pixels()
            .zip(b.pixels())
            .filter(|(p, q)| p.0.iter().zip(q.0).any(|(x, y)| x.abs_diff(y) > 40))
            .count()
    };
    let differences: usize = alone.iter().zip(&bare).map(|(a, b)| far(a, b)).sum();
    assert!(differences > 100, "the tail is elsewhere: {differences} pixels");
}

#[test]
fn a_sheet_shows_three_rows_of_moments_and_one_without_flesh() {
    let folder = Folder::new("sheet");
    if !folder.fox() {
        return;
    }
    folder.good("play fox.glb --clip Run --height 120 -o three.png");
    folder.good("play fox.glb --clip Run --height 120 --no-flesh -o one.png");
    let (three, one) = (png(&folder, "three.png"), png(&folder, "one.png"));
    assert_eq!(three.width(), one.width());
    let rows = three.height() - one.height();
    assert!((2 * 120..2 * 120 + 80).contains(&rows), "two rows and a legend more: {rows}");
    let orange = |p: &&image::Rgb<u8>| p.0[0] > 180 && p.0[2] < 100;
    assert!(one.pixels().filter(orange).count() > 6 * 800, "six foxes");
}

/// Whether a ring of pixels, `share` of the picture wide, is the same in all frames but for soft shadows.
fn border_is_still(all: &[RgbImage], share: f32) -> bool {
    let (width, height) = all[0].dimensions();
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "pixels"
    )]
    let margin = (height as f32 * share) as u32;
    let outer = |x: u32, y: u32| x.min(width - 1 - x) < margin || y.min(height - 1 - y) < margin;
    // Shadows make the wall darker and leave it grey; a character is of other colors.
    all.iter().all(|frame| {
        frame.enumerate_pixels().all(|(x, y, p)| {
            let [r, g, b] = p.0.map(i32::from);
            !outer(x, y) || ((r - b).abs() < 50 && (r - g).abs() < 30)
        })
    })
}

#[test]
fn nothing_leaves_the_picture_over_the_whole_clip() {
    let folder = Folder::new("frame");
    if !folder.fox() {
        return;
    }
    for clip in ["Survey", "Walk", "Run"] {
        folder.good(&format!("play fox.glb --clip {clip} --height 96 --alone -o a.gif"));
        let all = frames(&folder.read("a.gif")).0;
        assert!(border_is_still(&all, 0.04), "{clip}: the fox is at the border");
        assert!(!border_is_still(&all, 0.25), "{clip}: the fox fills the picture");
    }
}
