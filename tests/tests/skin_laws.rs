//! Laws of skinning and of taking offsets back, over random skeletons: they turn, move and scale with their input.

use proptest::prelude::*;
use sinew::kernel::skin::{BLOCK, Influences, LinearBlock, Rows, skin, skin_surface};
use sinew::kernel::unskin::{Limit, Tissue, unskin};

/// Points, of four influences each; not a multiple of a block.
const N: usize = 11;
const JOINTS: u16 = 5;
/// Weights exact in binary, so that they sum to 1 exactly.
const WEIGHTS: [f32; 4] = [0.5, 0.25, 0.1875, 0.0625];

type Vector = [f32; 3];

/// A map that turns, moves and stretches, far from flat.
fn maps() -> impl Strategy<Value = Vec<Rows>> {
    let map = (
        prop::array::uniform4(-1.0..1.0_f32),
        prop::array::uniform3(-2.0..2.0_f32),
        prop::array::uniform3(0.5..2.0_f32),
    );
    prop::collection::vec(map, usize::from(JOINTS)).prop_map(|all| {
        all.into_iter()
            .map(|(q, t, s)| {
                let q = sinew::math::quat::normalize([
                    q[0],
                    q[1],
                    q[2],
                    q[3] + if q[3] < 0.0 { -2.0 } else { 2.0 },
                ]);
                let columns = sinew::math::quat::to_columns(q);
                core::array::from_fn(|r| {
                    [columns[0][r] * s[0], columns[1][r] * s[1], columns[2][r] * s[2], t[r]]
                })
            })
            .collect()
    })
}

fn points() -> impl Strategy<Value = Vec<Vector>> {
    prop::collection::vec(prop::array::uniform3(-1.0..1.0_f32), N)
}

fn joints() -> impl Strategy<Value = Vec<u16>> {
    prop::collection::vec(0..JOINTS, 4 * N)
}

/// A rotation by rows.
fn turns() -> impl Strategy<Value = [Vector; 3]> {
    prop::array::uniform4(-1.0..1.0_f32).prop_map(|q| {
        let columns =
            sinew::math::quat::to_columns(sinew::math::quat::normalize([q[0], q[1], q[2], 1.5 + q[3]]));
        core::array::from_fn(|r| columns.map(|c| c[r]))
    })
}

fn turn(m: &[Vector; 3], v: Vector) -> Vector {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// `m·p`, the palette of a character that is turned as a whole.
fn turned(m: &[Vector; 3], palette: &[Rows]) -> Vec<Rows> {
    let of = |rows: &Rows| m.map(|row| core::array::from_fn(|c| (0..3).map(|k| row[k] * rows[k][c]).sum()));
    palette.iter().map(of).collect()
}

/// A set a point.
fn influences<'a>(joints: &'a [u16], weights: &'a [f32]) -> Influences<'a> {
    Influences { sets: 1, joints: joints.as_chunks().0, weights: weights.as_chunks().0 }
}

/// Positions and linear parts.
fn skinned(palette: &[Rows], joints: &[u16], rest: &[Vector]) -> (Vec<Vector>, Vec<LinearBlock>) {
    let weights = WEIGHTS.repeat(N);
    let influences = influences(joints, &weights);
    let (mut out, mut linear) = (vec![[0.0; 3]; N], vec![[[[0.0; BLOCK]; 3]; 3]; N.div_ceil(BLOCK)]);
    skin(palette, influences, rest, &mut out, &mut linear);
    (out, linear)
}

fn taken_back(palette: &[Rows], joints: &[u16], rest: &[Vector], y: &[Vector]) -> Vec<Vector> {
    let (_, linear) = skinned(palette, joints, rest);
    let weights = WEIGHTS.repeat(N);
    let influences = influences(joints, &weights);
    let limits = [Limit { gain: 1.0, inverse_square: 4.0 }];
    let mut out = vec![[0.0; 3]; N];
    let tissue = Tissue { softness: &[0.75; N], region: &[0; N], limits: &limits };
    unskin(palette, influences, &linear, y, tissue, &mut out);
    out
}

/// Largest difference.
fn distance(a: &[Vector], b: &[Vector]) -> f32 {
    a.as_flattened().iter().zip(b.as_flattened()).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    /// A palette of identities leaves everything where it is, bit for bit.
    #[test]
    fn rest_is_rest(joints in joints(), rest in points()) {
        let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let (out, _) = skinned(&[identity; JOINTS as usize], &joints, &rest);
        prop_assert_eq!(out, rest);
    }

    /// Mirrored and exchanged axes, and powers of two: bit for bit.
    #[test]
    fn axes_and_binary_scales_are_exact(palette in maps(), joints in joints(), rest in points()) {
        let (out, _) = skinned(&palette, &joints, &rest);
        let mirrored: Vec<Rows> = palette.iter().map(|[x, y, z]| [x.map(|c| -c), *z, *y]).collect();
        let want: Vec<Vector> = out.iter().map(|[x, y, z]| [-x, *z, *y]).collect();
        prop_assert_eq!(skinned(&mirrored, &joints, &rest).0, want);
        let scaled: Vec<Rows> = palette.iter().map(|rows| rows.map(|row| row.map(|c| 4.0 * c))).collect();
        let want: Vec<Vector> = out.iter().map(|p| p.map(|c| 4.0 * c)).collect();
        prop_assert_eq!(skinned(&scaled, &joints, &rest).0, want);
    }

    /// Positions and normals turn with the character.
    #[test]
    fn skin_turns_with_the_palette(palette in maps(), joints in joints(), rest in points(), m in turns()) {
        let (out, _) = skinned(&palette, &joints, &rest);
        let want: Vec<Vector> = out.iter().map(|p| turn(&m, *p)).collect();
        prop_assert!(distance(&skinned(&turned(&m, &palette), &joints, &rest).0, &want) < 4e-6);

        let weights = WEIGHTS.repeat(N);
        let surface = |palette: &[Rows]| {
            let influences = influences(&joints, &weights);
            let of: Vec<u32> = (0_u32..).take(N).collect();
            let (mut positions, mut normals) = (rest.clone(), vec![[0.6, 0.0, 0.8]; N]);
            skin_surface(palette, influences, &of, &mut positions, &mut normals);
            (positions, normals)
        };
        let ((p, n), (pm, nm)) = (surface(&palette), surface(&turned(&m, &palette)));
        prop_assert_eq!(&p, &out, "the surface and the points are skinned alike");
        prop_assert!(distance(&pm, &want) < 4e-6);
        let want: Vec<Vector> = n.iter().map(|n| turn(&m, *n)).collect();
        // Blending may nearly flatten a point; its normal is then ill-conditioned.
        let near: Vec<bool> = nm.iter().zip(&want).map(|(a, b)| distance(&[*a], &[*b]) < 1e-4).collect();
        prop_assert!(near.iter().filter(|near| !**near).count() <= 1, "{nm:?} {want:?}");
    }

    /// Offsets taken back do not know which way the character stands.
    #[test]
    fn offsets_taken_back_do_not_turn(palette in maps(), joints in joints(), rest in points(), y in points(), m in turns()) {
        let out = taken_back(&palette, &joints, &rest, &y);
        let y: Vec<Vector> = y.iter().map(|y| turn(&m, *y)).collect();
        let again = taken_back(&turned(&m, &palette), &joints, &rest, &y);
        for (a, b) in out.iter().zip(&again) {
            let size = a.iter().chain(b).fold(1.0_f32, |m, x| m.max(x.abs()));
            // An inverse of a nearly flat map magnifies rounding by its square.
            prop_assert!(distance(&[*a], &[*b]) < 1e-5 * size * size, "{a:?} {b:?}");
        }
    }
}
