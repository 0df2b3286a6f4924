//! People and the built-in character.

use crate::body::{MAKEHUMAN, makehuman};
use glam::DVec3;
use sinew_bake::builtin::character;
use sinew_bake::cage::layers::{INFLUENCES, Layers, Quality, Settings};
use sinew_bake::fem::element::Elements;

/// What must hold in every cage; prints a row of the table.
fn check(name: &str, layers: &Layers) -> Quality {
    let quality = layers.quality();
    let depths = [0.0, 0.05, 0.5, 0.95, 1.0].map(|q| libm::round(1e4 * quality.depth(q)) / 10.0);
    println!(
        "{name:13} columns {:5} prisms {:5} inverted {} negative {} unsound {} crossings {:?} between {:?} depth/mm {depths:?} \
         volume {:.4} unfolded {}",
        layers.columns(),
        layers.prisms.len(),
        quality.inverted,
        quality.negative,
        quality.unsound,
        quality.crossings,
        quality.between,
        quality.volume[1],
        layers.unfolded,
    );
    assert_eq!([quality.inverted, quality.negative, quality.unsound], [0; 3], "{name}");
    // Of the skin's own crossings the layers below have none.
    assert_eq!([&quality.crossings[..2], &quality.between].concat(), [0; 5], "{name}");
    assert!(quality.depth(0.0) > 0.0, "{name}: no column is without depth");
    let prisms =
        Elements::prisms(&layers.rest, layers.prisms.clone()).unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!(prisms.len(), 2 * layers.skin.len(), "{name}");
    check_weights(name, layers);
    check_tets(name, layers);
    quality
}

/// Tetrahedra have volumes, and are below most triangles.
fn check_tets(name: &str, layers: &Layers) {
    let nodes = [&layers.rest[..], &layers.core].concat();
    let tets = Elements::tets(&nodes, layers.tets.clone()).unwrap_or_else(|e| panic!("{name}: {e}"));
    let volume: f64 = tets.volumes.iter().sum();
    println!("{name:13} tets {} of {} volume {volume:.4}", tets.len(), 3 * layers.skin.len());
    assert!(10 * tets.len() > 8 * 3 * layers.skin.len(), "{name}");
    assert_eq!(layers.core.len(), layers.columns(), "{name}");
    if layers.fixed.iter().filter(|f| **f).count() == layers.columns() {
        // Closed: the bone wrap encloses a volume, and tetrahedra are in most of it.
        let at = |i: u32| layers.rest[i as usize];
        let enclosed: f64 =
            layers.triangles().iter().map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum();
        println!("{name:13} of {enclosed:.4}");
        assert!((0.9..1.0).contains(&(volume / enclosed)), "{name}: {volume} of {enclosed}");
    }
}

fn check_weights(name: &str, layers: &Layers) {
    assert_eq!([layers.weights.len(), layers.fixed.len()], [layers.columns(), layers.rest.len()], "{name}");
    let rows = layers.prism_weights();
    assert_eq!(rows.len(), layers.skin.len(), "{name}");
    for row in layers.weights.iter().chain(&rows) {
        assert!((row.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-14, "{name}: {row:?}");
        assert!(
            row.is_sorted_by_key(|(node, _)| *node) && row.iter().all(|(_, w)| *w > 0.0),
            "{name}: {row:?}"
        );
    }
    assert!(rows.iter().all(|row| row.len() <= INFLUENCES), "{name}");
}

/// Flesh of people: about 4,000 columns; the paper's skin is 25.6 mm above bone in the median.
#[test]
fn people_have_flesh_without_inverted_prisms() {
    for name in MAKEHUMAN {
        let Some(model) = makehuman(name) else { continue };
        let layers = Layers::new(&model, &Settings::default()).unwrap_or_else(|e| panic!("{e}"));
        let quality = check(name, &layers);
        assert!((3_800..4_100).contains(&layers.columns()), "{name}: {}", layers.columns());
        assert_eq!(quality.crossings[2], 0, "{name}");
        assert!((0.020..0.036).contains(&quality.depth(0.5)), "{name}: {}", quality.depth(0.5));
        assert!(quality.depth(0.01) > 0.005, "{name}: {}", quality.depth(0.01));
        let [_, volume] = quality.volume;
        assert!((0.025..0.060).contains(&volume), "{name}: {volume}");
    }
}

/// The size of the paper: hands, feet and head included.
#[test]
fn a_whole_body_has_the_size_of_the_paper() {
    let Some(model) = makehuman("mh_f_average") else { return };
    let layers = Layers::new(&model, &Settings::everywhere()).unwrap_or_else(|e| panic!("{e}"));
    check("whole", &layers);
    assert_eq!([layers.columns(), layers.prisms.len()], [13_380, 53_512]);
    assert_eq!(layers.fixed.iter().filter(|f| !**f).count(), 26_760);
    // Folds of toes were opened; all other vertices are where they were.
    assert!(layers.unfolded < 50, "{}", layers.unfolded);
    let rest = model.rest_positions();
    let n = layers.columns();
    let off: Vec<f64> = layers
        .column_of
        .iter()
        .zip(&rest)
        .filter_map(|(c, p)| Some(layers.rest[2 * n + (*c)? as usize].distance(*p)))
        .collect();
    assert_eq!(off.len(), 14_517);
    assert!(off.iter().all(|d| *d < 0.005), "{:?}", off.iter().copied().fold(0.0, f64::max));
    assert!(off.iter().filter(|d| **d > 1e-6).count() < 60);
}

/// The character is symmetric in x, and so are its layers: no order of columns shows in them.
#[test]
fn the_built_in_character_is_symmetric() {
    let layers = Layers::new(&character(), &Settings::everywhere()).unwrap();
    check("Plum", &layers);
    let n = layers.columns();
    let skin = &layers.rest[2 * n..];
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| skin[*a].y.total_cmp(&skin[*b].y));
    let mut worst = 0.0_f64;
    for (i, p) in skin.iter().enumerate() {
        let image = DVec3::new(-p.x, p.y, p.z);
        let from = order.partition_point(|j| skin[*j].y < p.y - 1e-6);
        let near = order[from..].iter().take_while(|j| skin[**j].y <= p.y + 1e-6);
        let twin = near.min_by(|a, b| skin[**a].distance(image).total_cmp(&skin[**b].distance(image)));
        let twin = *twin.expect("itself at least");
        assert!(skin[twin].distance(image) < 1e-6, "{p} has no twin");
        for layer in [0, n] {
            let [x, y, z] = layers.rest[layer + i].to_array();
            worst = worst.max(layers.rest[layer + twin].distance(DVec3::new(-x, y, z)));
        }
    }
    println!("asymmetry {worst:.3e} m");
    assert!(worst < 1e-5, "{worst}");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let model = character();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Layers::new(&model, &Settings::default()).unwrap())
    };
    assert_eq!(with(1), with(3));
}

/// Bones inside the flesh, and points of the skin, are found in the cage.
#[test]
fn points_of_the_flesh_are_embedded() {
    let Some(model) = makehuman("mh_m_average") else { return };
    let layers = Layers::new(&model, &Settings::default()).unwrap();
    let n = layers.columns();
    // Points between the layers of every column, off it towards the middle of one of its triangles.
    let corner = |k: usize, i: u32| layers.rest[k * n + i as usize - 2 * n];
    let points: Vec<DVec3> = layers
        .skin
        .iter()
        .flat_map(|t| {
            [0.03, 0.5, 0.98].map(|s| {
                let at = |k: usize| 0.7 * corner(k, t[0]) + 0.2 * corner(k, t[1]) + 0.1 * corner(k, t[2]);
                (1.0 - s) * at(1) + s * at(2)
            })
        })
        .collect();
    let places = layers.embed(&points);
    let mut worst = 0.0_f64;
    for (place, p) in places.iter().zip(&points) {
        let nodes = layers.prisms[place.prism as usize].map(|i| layers.rest[i as usize]);
        assert!(place.residual.length() < 1e-9, "{p}: {place:?}");
        worst = worst.max(place.place.point(&nodes).distance(*p));
    }
    println!("{} points, error {worst:.3e} m", points.len());
    // A point far outside keeps what is left to it.
    let far = layers.embed(&[DVec3::new(5.0, 1.0, 0.0)])[0];
    let nodes = layers.prisms[far.prism as usize].map(|i| layers.rest[i as usize]);
    assert!((far.place.point(&nodes) + far.residual).distance(DVec3::new(5.0, 1.0, 0.0)) < 1e-12);
}
