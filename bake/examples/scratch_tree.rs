#![allow(clippy::all, clippy::pedantic, missing_docs)]
use std::path::Path;
fn show(
    m: &sinew_bake::Model,
    i: usize,
    d: usize,
    area: &[f64],
    cnt: &[usize],
    jn: &[bool],
    t: &[glam::DMat4],
    size: f64,
) {
    if jn[i] || d > 0 {
        let p = t[i].w_axis.truncate() / size;
        println!(
            "{}{} {} n={} w={:.1} [{:.3} {:.3} {:.3}]",
            "  ".repeat(d),
            m.nodes[i].name,
            if jn[i] { "" } else { "(not joint)" },
            cnt[i],
            area[i],
            p.x,
            p.y,
            p.z
        );
    }
    for c in 0..m.nodes.len() {
        if m.nodes[c].parent == Some(i) {
            show(m, c, d + 1, area, cnt, jn, t, size);
        }
    }
}
fn main() {
    for f in std::env::args().skip(1) {
        println!("=== {f}");
        let m = match sinew_bake::import::import(Path::new(&f)) {
            Ok(m) => m,
            Err(e) => {
                println!("{e}");
                continue;
            }
        };
        let mut area = vec![0.0; m.nodes.len()];
        let mut cnt = vec![0; m.nodes.len()];
        let mut jn = vec![false; m.nodes.len()];
        for j in &m.joints {
            jn[j.node] = true;
        }
        for p in &m.primitives {
            for v in 0..p.positions.len() {
                for k in 0..p.stride {
                    let w = p.weights[v * p.stride + k] as f64;
                    let n = m.joints[p.joints[v * p.stride + k] as usize].node;
                    area[n] += w;
                    if k == 0 {
                        cnt[n] += 1;
                    }
                }
            }
        }
        let pos = m.rest_positions();
        let lo = pos.iter().fold(glam::DVec3::INFINITY, |a, b| a.min(*b));
        let hi = pos.iter().fold(glam::DVec3::NEG_INFINITY, |a, b| a.max(*b));
        let size = (hi - lo).length();
        println!("size {size} lo {:?} hi {:?} verts {}", lo / size, hi / size, pos.len());
        let t = m.rest_transforms();
        for i in 0..m.nodes.len() {
            if m.nodes[i].parent.is_none() {
                show(&m, i, 0, &area, &cnt, &jn, &t, size);
            }
        }
    }
}
