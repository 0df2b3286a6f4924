//! Every public setter, from a script of bytes.

use super::{assert_finite, assert_state_returns, with_tube};
use sinew::replay::{Event, Extent, Recorder, Replay, Verdict, verify};
use sinew::{Affine, Pose, Root, Tunables};

/// Most calls of a script.
const MOST_CALLS: usize = 200;

/// Takes numbers off a script; zeros past its end.
struct Script<'a>(&'a [u8]);

impl Script<'_> {
    fn array<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.0.split_at(self.0.len().min(N));
        self.0 = rest;
        core::array::from_fn(|i| head.get(i).copied().unwrap_or(0))
    }

    fn byte(&mut self) -> u8 {
        let [byte] = self.array();
        byte
    }

    /// Any float, or one of ordinary size.
    fn float(&mut self) -> f32 {
        match self.byte() {
            kind @ 0..8 => {
                f32::from(i16::from_le_bytes(self.array())) * [1e-4, 1e-3, 1e-2, 1.0][usize::from(kind % 4)]
            }
            _ => f32::from_le_bytes(self.array()),
        }
    }

    fn root(&mut self) -> Root {
        let wide = self.byte() > 200;
        let place = |s: &mut Self| if wide { f64::from_le_bytes(s.array()) } else { f64::from(s.float()) };
        let translation = [place(self), place(self), place(self)];
        let turn = self.float();
        Root {
            translation,
            rotation: if wide {
                [turn, self.float(), self.float(), self.float()]
            } else {
                [0.0, turn, 0.0, 1.0]
            },
        }
    }

    /// The tube's joints, some entries replaced.
    fn joints(&mut self) -> [Affine; 3] {
        let mut joints = crate::recording::pose(self.byte());
        for _ in 0..self.byte() % 4 {
            let at = usize::from(self.byte()) % 36;
            joints.as_flattened_mut().as_flattened_mut()[at] = self.float();
        }
        joints
    }
}

/// Runs a script on a recorded character, then verifies the recording.
pub(super) fn setters(bytes: &[u8]) {
    let mut script = Script(bytes);
    let film = with_tube(|c| {
        let mut recorder = Recorder::new(c, u32::from(script.byte() % 8), Vec::new()).expect("memory");
        let mut state = vec![0; recorder.character().state_len()];
        for _ in 0..MOST_CALLS {
            if script.0.is_empty() {
                break;
            }
            call(&mut script, &mut recorder, &mut state);
            assert_finite(recorder.character());
        }
        let film = recorder.finish().expect("memory").0;
        assert_state_returns(c);
        film
    });
    let replay = Replay::parse(&film).expect("what was recorded can be read");
    let verdict = with_tube(|c| verify(c, &replay, Extent::FirstDifference, |_, _| {}));
    assert_eq!(verdict, Ok(Verdict::Same { frames: replay.finished().frames }), "it comes out the same");
}

/// One call; refusals are as good as any.
fn call(script: &mut Script<'_>, recorder: &mut Recorder<'_, '_, Vec<u8>>, state: &mut [u8]) {
    let _ = match script.byte() % 16 {
        0 => recorder.freeze(script.byte() > 127),
        1 => recorder.set_rate_divisor(u32::from_le_bytes(script.array())),
        2 => recorder.teleport(),
        3 => recorder.settle(),
        4 => recorder.reset(),
        5 | 6 => {
            let mut words = recorder.character().tunables().to_words();
            for _ in 0..=script.byte() % 3 {
                words[usize::from(script.byte()) % Tunables::WORDS] = script.float();
            }
            match Tunables::from_words(&words) {
                Ok(tunables) => recorder.set_tunables(&tunables),
                Err(error) => Err(error.into()),
            }
        }
        7 => recorder.character().save_state(state).map_err(Into::into),
        8 => recorder.load_state(state),
        9 => {
            let at = usize::from(u16::from_le_bytes(script.array())) % (state.len() - 8);
            state[at] ^= script.byte();
            let end = state.len() - 8;
            let digest = sinew::math::digest::of_bytes(&state[..end]);
            state[end..].copy_from_slice(&digest.to_le_bytes());
            recorder.event(&Event::Load(state))
        }
        10..13 => {
            let (clip, t, root, dt) =
                (u32::from(script.byte() / 250), script.float(), script.root(), script.float());
            recorder.step_clip(clip, t, root, dt.abs()).map(|_| ())
        }
        _ => {
            let (joints, root, dt) = (script.joints(), script.root(), script.float());
            recorder.step(Pose { root, root_from_joint: &joints }, dt).map(|_| ())
        }
    };
}
