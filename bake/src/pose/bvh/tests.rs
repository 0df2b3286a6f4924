use super::*;

const SMALL: &str = "HIERARCHY\r\nROOT left hip{\r\n OFFSET 1 2 3\r\n CHANNELS 4 Xposition Zrotation Xrotation Yrotation\r\n\
    JOINT knee\r\n {\r\n  OFFSET 0 -4 0\r\n  CHANNELS 1 xrotation\r\n  End Site\r\n  {\r\n   OFFSET 0 -.5e1 0\r\n  }\r\n }\r\n}\r\n\
    MOTION\r\nFrames: 2\r\nFrame Time: .25\r\n0 0 0 0 0\r\n7 90 0 90 90\r\n\r\n";

fn read(text: &str) -> Result<Bvh, Error> {
    Bvh::from_bytes("a.bvh", text.as_bytes())
}

#[test]
fn rotations_are_taken_in_the_files_order() {
    let bvh = read(SMALL).unwrap();
    assert_eq!((bvh.frames(), bvh.frame_time, bvh.joints[0].name.as_str()), (2, 0.25, "left hip"));
    assert_eq!(bvh.joints[1].channels, [Channel::Rotation(0)]);
    let placed = bvh.placed(1);
    // By hand: the hip turns by 90 degrees about Y and then about Z, the knee about X before both.
    let near = |a: DVec3, b: [f64; 3]| assert!(a.distance(DVec3::from_array(b)) < 1e-14, "{a} {b:?}");
    near(placed[0].translation, [7.0, 2.0, 3.0]);
    near(placed[0].rotation * DVec3::X, [0.0, 0.0, -1.0]);
    near(placed[0].rotation * DVec3::Y, [-1.0, 0.0, 0.0]);
    near(placed[1].translation, [11.0, 2.0, 3.0]);
    near(placed[1].rotation * DVec3::Z, [1.0, 0.0, 0.0]);
    near(bvh.rest()[1].translation, [1.0, -2.0, 3.0]);
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let cases = [
        ("HIERARCHY", "HIERARCHIE", "line 1", "`HIERARCHIE` where `HIERARCHY` should be"),
        ("JOINT knee", "JOINT left hip", "line 5", "a second joint is called `left hip`"),
        ("JOINT knee", "JOINT ", "line 5", "a joint has no name"),
        ("CHANNELS 1 xrotation", "CHANNELS 1 rotation", "line 8", "`rotation` is no channel"),
        ("CHANNELS 4 Xposition Zrotation", "CHANNELS 4 Zrotation Zrotation", "line 4", "twice there"),
        ("CHANNELS 4", "CHANNELS 99999999999", "line 4", "99999999999 channels"),
        ("CHANNELS 4", "CHANNELS -4", "line 4", "`-4`, which is no count"),
        ("OFFSET 0 -4 0", "OFFSET 0 -4,0 0", "line 7", "`-4,0`, which is no number"),
        ("OFFSET 0 -4 0", "OFFSET 0 NaN 0", "line 7", "no measure"),
        ("OFFSET 0 -4 0", "OFFSET 0 -4e9 0", "line 7", "no measure"),
        ("OFFSET 0 -4 0", "OFFSET 0 -4", "line 8", "`CHANNELS`, which is no number"),
        (" }\r\n}\r\n", " }\r\n", "line 14", "`MOTION` where `JOINT`"),
        ("Frames: 2", "Frames: 0", "line 16", "no frames"),
        ("Frames: 2", "Frames: 18446744073709551615", "line 20", "ends after 2 of 18446744073709551615"),
        ("Frames: 2", "Frames: 1", "line 19", "more after 1 frames"),
        ("Time: .25", "Time: 0", "line 17", "the frame time is `0 `"),
        ("Time: .25", "Time: inf", "line 17", "no measure"),
        ("7 90 0 90 90", "7 90 0 90", "line 19", "frame 1 has 4 numbers, the skeleton 5 channels"),
        ("7 90 0 90 90", "7 90 0 90 x", "line 19", "`x`, which is no number"),
    ];
    for (old, new, place, problem) in cases {
        let text = SMALL.replacen(old, new, 1);
        assert_ne!(text, SMALL, "{old} is there");
        let error = read(&text).expect_err(new).to_string();
        assert!(error.starts_with(&format!("a.bvh: {place}: ")), "{error}");
        assert!(error.contains(problem) && error.contains("; ") && error.lines().count() == 1, "{error}");
    }
    let error = Bvh::from_bytes("a.bvh", b"HIERARCHY\nROOT \xff").unwrap_err().to_string();
    assert!(error.starts_with("a.bvh: line 2: it is not text"), "{error}");
}

#[test]
fn a_deep_hierarchy_neither_overflows_nor_grows() {
    let joint = |i: usize| format!("JOINT j{i} {{ \nOFFSET 0 1 0 CHANNELS 1 Xrotation\n");
    let deep = |n: usize| {
        let joints: String = (0..n).map(joint).collect();
        let head = "HIERARCHY ROOT r {\n OFFSET 0 0 0 CHANNELS 0\n";
        format!("{head}{joints}{}\nMOTION\nFrames: 1\nFrame Time: 1\n{}", "}\n".repeat(n + 1), "1 ".repeat(n))
    };
    let bvh = read(&deep(4000)).unwrap();
    assert_eq!(bvh.placed(0).len(), 4001);
    assert!(read(&deep(5000)).unwrap_err().to_string().contains("more than 4096 joints"));
}

/// Every cut, and thousands of files with bytes exchanged, moved or left out: an error or a motion, never a panic.
#[test]
fn mangled_files_are_refused_or_read() {
    let mut refused = 0;
    let mut try_bytes = |bytes: &[u8]| match Bvh::from_bytes("a.bvh", bytes) {
        Err(error) => {
            refused += 1;
            assert!(error.to_string().lines().count() == 1, "{error}");
        }
        Ok(bvh) => {
            for frame in 0..bvh.frames() {
                assert!(
                    bvh.placed(frame).iter().all(|p| p.translation.is_finite() && p.rotation.is_finite())
                );
            }
            assert!(bvh.first_frame() <= bvh.frames());
        }
    };
    (0..SMALL.len()).for_each(|end| try_bytes(&SMALL.as_bytes()[..end]));
    let mut state = 1_u32;
    let mut random = |n: usize| {
        state = sinew::math::noise::hash(state.wrapping_add(0x9e37_79b9));
        state as usize % n
    };
    for _ in 0..20_000 {
        let mut bytes = SMALL.as_bytes().to_vec();
        for _ in 0..=random(3) {
            let (at, to) = (random(bytes.len()), random(bytes.len()));
            match random(4) {
                0 => bytes[at] = u8::try_from(random(256)).unwrap(),
                1 => bytes.swap(at, to),
                2 => drop(bytes.drain(at.min(to)..at.max(to).min(at.min(to) + 12))),
                _ => bytes[at] = b"0123456789.-e{} \n"[random(17)],
            }
        }
        try_bytes(&bytes);
    }
    assert!(refused > 10_000, "{refused} refused");
}
