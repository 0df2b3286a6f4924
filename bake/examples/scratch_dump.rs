#![allow(clippy::all, clippy::pedantic, missing_docs)]
use sinew_bake::recipe;
use std::{io::Write, path::Path, time::Instant};
fn main() {
    let dir = std::env::args().nth(1).unwrap();
    for f in std::env::args().skip(2) {
        let m = match sinew_bake::import::import(Path::new(&f)) {
            Ok(m) => m,
            Err(e) => {
                println!("{e}");
                continue;
            }
        };
        let t = Instant::now();
        let fl = match recipe::flesh(&m, &recipe::Recipe::default()) {
            Ok(m) => m,
            Err(e) => {
                println!("{e}");
                continue;
            }
        };
        println!(
            "== {} {} verts {:.2}s mirror {:?} notes {:?}",
            m.name,
            m.vertex_count(),
            t.elapsed().as_secs_f64(),
            fl.mirror.map(|m| (m.normal, m.matched, m.of_bind_pose)),
            fl.notes
        );
        for (i, r) in fl.regions.iter().enumerate() {
            let n = fl.region.iter().filter(|x| **x as usize == i).count();
            println!(
                "   {:?} n={n} soft={}",
                r,
                fl.region.iter().zip(&fl.softness).filter(|(x, s)| **x as usize == i && **s > 0.3).count()
            );
        }
        let pos = m.rest_positions();
        let mut o = std::io::BufWriter::new(
            std::fs::File::create(format!(
                "{dir}/{}_{}.bin",
                Path::new(&f).parent().unwrap().file_name().unwrap().to_str().unwrap(),
                m.name
            ))
            .unwrap(),
        );
        let mut tris = vec![];
        let mut st = 0u32;
        for p in &m.primitives {
            for t in &p.indices {
                tris.push(t.map(|x| x + st));
            }
            st += p.positions.len() as u32;
        }
        let mut jump = 0f32;
        let mut steep = 0f64;
        for t in &tris {
            for k in 0..3 {
                let (a, b) = (t[k] as usize, t[(k + 1) % 3] as usize);
                let d = (fl.softness[a] - fl.softness[b]).abs();
                jump = jump.max(d);
                let l = pos[a].distance(pos[b]) / fl.body_size;
                if d > 0.0 {
                    steep = steep.max(d as f64 / l.max(1e-9));
                }
            }
        }
        println!("   max edge jump {jump} steep {steep:.1}");
        o.write_all(&(pos.len() as u32).to_le_bytes()).unwrap();
        o.write_all(&(tris.len() as u32).to_le_bytes()).unwrap();
        for p in &pos {
            let q = (*p / fl.body_size).as_vec3();
            for c in q.to_array() {
                o.write_all(&c.to_le_bytes()).unwrap();
            }
        }
        for s in &fl.softness {
            o.write_all(&s.to_le_bytes()).unwrap();
        }
        for t in &tris {
            for c in t {
                o.write_all(&c.to_le_bytes()).unwrap();
            }
        }
        o.write_all(&fl.region).unwrap();
    }
}
