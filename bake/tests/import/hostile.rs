//! Files that must be refused with a clear error, and files that must merely never panic.

use serde_json::json;

use crate::builder::{Builder, F32, import_alone, square};
use crate::data::shared;

/// Asserts that the file of `change` is refused with all of `parts` in the message.
#[track_caller]
fn refuses(parts: &[&str], change: impl FnOnce(&mut Builder)) {
    let mut b = square();
    assert!(b.import().is_ok(), "the unchanged file is fine");
    change(&mut b);
    let error = b.refused();
    assert!(error.starts_with("test.gltf: ") && !error.contains('\n'), "{error}");
    for part in parts {
        assert!(error.contains(part), "`{part}` is missing in `{error}`");
    }
}

#[test]
fn what_is_not_gltf_is_refused() {
    for (bytes, part) in [
        (&b""[..], "the file is empty"),
        (b"   ", "not a glTF file"),
        (b"\x89PNG\r\n", "not a glTF file"),
        (b"<html>", "not a glTF file"),
        (b"glTF", "GLB container"),
        (b"glTF\x02\0\0\0\x05\0\0\0", "GLB container"),
        (b"glTF\x01\0\0\0\x14\0\0\0\0\0\0\0JSON", "GLB container"),
        (b"{", "JSON"),
        (b"{}", "glTF version is missing"),
        (br#"{"asset": {"version": "1.0"}, "meshes": {}}"#, "glTF version is 1.0"),
        (br#"{"asset": {"version": "2.0"}}"#, "no mesh has a skin"),
    ] {
        let error = import_alone("odd.glb", bytes).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
    let deep = [b"{\"a\":".repeat(100_000), b"}".to_vec()].concat();
    assert!(import_alone("deep.gltf", &deep).is_err(), "nesting must not overflow the stack");
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = sinew_bake::import::import("no/such/file.glb".as_ref()).unwrap_err().to_string();
    assert!(error.contains("no/such/file.glb: cannot be read"), "{error}");
}

#[test]
fn a_glb_cut_anywhere_is_refused() {
    let Some(path) = shared("khronos/Fox.glb") else { return };
    let bytes = std::fs::read(path).unwrap();
    for length in (0..bytes.len()).step_by(97) {
        let error = import_alone("Fox.glb", &bytes[..length]).unwrap_err().to_string();
        assert!(
            error.contains("empty") || error.contains("GLB") || error.contains("not a glTF"),
            "{length}: {error}"
        );
    }
    assert!(import_alone("Fox.glb", &bytes).is_ok());
}

#[test]
fn bad_weights_are_refused_with_mesh_and_vertex() {
    let place = ["mesh 0 \"belly\", primitive 0, vertex 2"];
    for (bad, part) in [(0.0, "sum to 0"), (f32::NAN, "NaN"), (-1.0, "-1"), (f32::INFINITY, "inf")] {
        refuses(&[place[0], part, "normalize"], |b| {
            b.json["meshes"][0]["name"] = json!("belly");
            let mut weights = [1.0, 0.0, 0.0, 0.0].repeat(4);
            weights[8] = bad;
            let weights = b.floats("VEC4", 4, &weights);
            b.attribute("WEIGHTS_0", weights);
        });
    }
}

#[test]
fn bad_joints_and_skins_are_refused() {
    refuses(&["mesh 0, primitive 0, vertex 3", "joint 2 is out of range: the skin has 2"], |b| {
        let joints = b.bytes("VEC4", 4, &[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0]);
        b.attribute("JOINTS_0", joints);
    });
    refuses(&["skin 0, joint 1", "no node 9"], |b| b.json["skins"][0]["joints"] = json!([1, 9]));
    refuses(&["node 0", "no skin 5"], |b| b.json["nodes"][0]["skin"] = json!(5));
    refuses(&["skin 0", "1 inverse bind matrices for 2 joints"], |b| {
        let matrices = b.floats("MAT4", 1, &[0.0; 16]);
        b.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
    });
    refuses(&["skin 0, joint 0", "not finite"], |b| {
        let matrices = b.floats("MAT4", 2, &[f32::NAN; 32]);
        b.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
    });
    refuses(&["JOINTS_0", "F32 where unsigned integers belong"], |b| {
        let joints = b.floats("VEC4", 4, &[0.0; 16]);
        b.attribute("JOINTS_0", joints);
    });
    refuses(&["one of JOINTS_1 and WEIGHTS_1 only"], |b| b.attribute("JOINTS_1", 2));
}

#[test]
fn bad_geometry_is_refused() {
    for bad in [f32::NAN, f32::INFINITY] {
        refuses(&["mesh 0, primitive 0, vertex 1", "position is not finite"], |b| {
            let positions = b.floats("VEC3", 4, &[0., 0., 0., 0., bad, 0., 0., 0., 0., 0., 0., 0.]);
            b.attribute("POSITION", positions);
        });
    }
    refuses(&["index 5 refers to vertex 4 of 4"], |b| {
        let indices = b.bytes("SCALAR", 6, &[0, 1, 2, 0, 2, 4]);
        b.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    });
    refuses(&["WEIGHTS_0", "3 elements for 4 vertices"], |b| b.json["accessors"][3]["count"] = json!(3));
    refuses(&["node 0", "no mesh 3"], |b| b.json["nodes"][0]["mesh"] = json!(3));
    refuses(&["no material 3"], |b| b.json["meshes"][0]["primitives"][0]["material"] = json!(3));
    refuses(&["mode is unknown"], |b| b.json["meshes"][0]["primitives"][0]["mode"] = json!(9));
    refuses(&["no accessor 99"], |b| b.attribute("POSITION", 99));
    refuses(&["_SINEW, vertex 3", "not a number"], |b| {
        let painted = b.floats("SCALAR", 4, &[0., 0., 0., f32::NAN]);
        b.attribute("_SINEW", painted);
    });
}

#[test]
fn bad_hierarchies_are_refused() {
    refuses(&["its own ancestor"], |b| b.json["nodes"][2]["children"] = json!([1]));
    refuses(&["node 1 \"root\"", "its own ancestor"], |b| b.json["nodes"][1]["children"] = json!([1]));
    refuses(&["also a child of node 0"], |b| b.json["nodes"][0]["children"] = json!([2]));
    refuses(&["node 1 \"root\"", "no node 7"], |b| b.json["nodes"][1]["children"] = json!([7]));
    refuses(&["node 2 \"tip\"", "not finite"], |b| b.json["nodes"][2]["translation"] = json!([1e39, 0, 0]));
    refuses(&["scene", "no node 7"], |b| b.json["scenes"] = json!([{"nodes": [7]}]));
}

#[test]
fn accessors_beyond_their_bytes_are_refused() {
    let past = "reach past the end of its buffer view";
    refuses(&["POSITION (accessor 0)", past], |b| b.json["accessors"][0]["count"] = json!(5));
    refuses(&[past], |b| b.json["accessors"][0]["byteOffset"] = json!(4));
    refuses(&[past], |b| b.json["accessors"][0]["byteOffset"] = json!(u64::MAX - 3));
    refuses(&[past], |b| b.json["accessors"][0]["count"] = json!(10_000_000));
    refuses(&["more data than any character"], |b| b.json["accessors"][0]["count"] = json!(u32::MAX));
    refuses(&["too many"], |b| b.json["accessors"][0]["count"] = json!(u64::MAX));
    refuses(&["not aligned"], |b| b.json["accessors"][0]["byteOffset"] = json!(2));
    refuses(&["overlap"], |b| b.json["bufferViews"][0]["byteStride"] = json!(4));
    refuses(&[past], |b| b.json["bufferViews"][0]["byteStride"] = json!(1_u64 << 62));
    refuses(&["buffer view 0 reaches past the end of buffer 0"], |b| {
        b.json["bufferViews"][0]["byteLength"] = json!(1 << 20);
    });
    refuses(&["buffer view 0 reaches past"], |b| {
        b.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX - 3);
    });
    refuses(&["buffer 4", "no data"], |b| b.json["bufferViews"][0]["buffer"] = json!(4));
    refuses(&["no buffer view 40"], |b| b.json["accessors"][0]["bufferView"] = json!(40));
    refuses(&["type is Vec2, not Vec3"], |b| b.json["accessors"][0]["type"] = json!("VEC2"));
    refuses(&["component type is unknown"], |b| b.json["accessors"][0]["componentType"] = json!(77));
    refuses(&["belongs to no attribute"], |b| b.json["accessors"][0]["type"] = json!("MAT3"));
}

#[test]
fn sparse_accessors_cannot_ask_for_much_or_reach_beyond() {
    let sparse = |rows: usize, values: usize, count: u64| json!({"count": count, "indices": {"bufferView": rows, "componentType": 5121}, "values": {"bufferView": values}});
    refuses(&["without any bytes"], |b| {
        let accessor =
            json!({"componentType": F32, "type": "VEC3", "count": 20_000_000, "sparse": sparse(1, 0, 1)});
        let accessor = b.push("accessors", accessor);
        b.attribute("POSITION", accessor);
    });
    refuses(&["sparse entry 0 replaces element 200"], |b| {
        let row = b.view(&[200]);
        b.json["accessors"][0]["sparse"] = sparse(row, 0, 1);
    });
    refuses(&["more sparse entries than elements"], |b| {
        b.json["accessors"][0]["sparse"] = sparse(1, 0, u64::MAX);
    });
    refuses(&["reach past the end"], |b| {
        let row = b.view(&[1]);
        b.json["accessors"][0]["sparse"] = sparse(row, 0, 2);
    });
}

#[test]
fn a_small_file_cannot_expand_without_bound() {
    // A million vertices, drawn by a thousand nodes.
    refuses(&["more data than any character"], |b| {
        let count = 1_000_000;
        let weights = [255, 0, 0, 0].repeat(count);
        let positions = b.bytes("VEC3", count, &vec![0; 3 * count]);
        let joints = b.bytes("VEC4", count, &vec![0; 4 * count]);
        let weights = b.accessor(&weights, 5121, "VEC4", count, true);
        for (name, accessor) in [("POSITION", positions), ("JOINTS_0", joints), ("WEIGHTS_0", weights)] {
            b.attribute(name, accessor);
        }
        for _ in 0..1_000 {
            b.push("nodes", json!({"mesh": 0, "skin": 0}));
        }
    });
}

#[test]
fn unknown_required_extensions_are_refused_with_the_remedy() {
    for (name, remedy) in [
        ("KHR_draco_mesh_compression", "without mesh compression"),
        ("EXT_meshopt_compression", "without mesh compression"),
        ("ACME_voxels", "without this extension"),
    ] {
        refuses(&[name, "not supported", remedy], |b| b.json["extensionsRequired"] = json!([name]));
    }
    let mut b = square();
    b.json["extensionsRequired"] = json!(["VRMC_vrm", "KHR_materials_unlit", "KHR_texture_transform"]);
    assert!(b.import().is_ok());
}

#[test]
fn bad_clips_are_refused() {
    let animate = |b: &mut Builder, times: &[f32], values: &[f32], node: usize| {
        let input = b.floats("SCALAR", times.len(), times);
        let output = b.floats("VEC3", values.len() / 3, values);
        b.push(
            "animations",
            json!({"name": "hop", "samplers": [{"input": input, "output": output}],
            "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}]}),
        );
    };
    let place = "animation 0 \"hop\", channel 0";
    refuses(&[place, "3 values where 2 keys need 6"], |b| animate(b, &[0., 1.], &[0.; 3], 1));
    refuses(&[place, "not finite"], |b| animate(b, &[0., f32::NAN], &[0.; 6], 1));
    refuses(&[place, "not finite"], |b| animate(b, &[0., 1.], &[f32::INFINITY; 6], 1));
    refuses(&[place, "no node 9"], |b| animate(b, &[0., 1.], &[0.; 6], 9));
    refuses(&[place, "no sampler 3"], |b| {
        animate(b, &[0., 1.], &[0.; 6], 1);
        b.json["animations"][0]["channels"][0]["sampler"] = json!(3);
    });
}

#[test]
fn broken_buffers_are_refused() {
    let with_uri = |uri: &str| {
        let mut json = square().json;
        json["buffers"] = json!([{"byteLength": 8, "uri": uri}]);
        import_alone("x.gltf", &serde_json::to_vec(&json).unwrap()).unwrap_err().to_string()
    };
    assert!(with_uri("data:text/plain").contains("no comma"));
    assert!(with_uri("data:;base64,*").contains("data URI"));
    assert!(with_uri("data:;base64,AAAA").contains("3 bytes where the file promises 8"));
    assert!(with_uri("https://example.com/a.bin").contains("on the network"));
    assert!(with_uri("%FF").contains("not UTF-8"));
}

/// Numerical Recipes' generator: the same mutations everywhere.
struct Lcg(u32);

impl Lcg {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as usize % bound
    }
}

/// A file that uses as much of the importer as fits into a few kilobytes.
fn rich() -> Builder {
    let mut b = square();
    let rows = b.view(&[3]);
    let values = b.view(&[5.0_f32, 6.0, 7.0].map(f32::to_le_bytes).concat());
    b.json["accessors"][0]["sparse"] = json!({"count": 1, "indices": {"bufferView": rows, "componentType": 5121}, "values": {"bufferView": values}});
    let times = b.floats("SCALAR", 2, &[0.5, 2.0]);
    let turns = b.floats("VEC4", 2, &[0., 0., 0., 1., 0., 0., 1., 0.]);
    b.push(
        "animations",
        json!({"samplers": [{"input": times, "output": turns}],
        "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}),
    );
    let painted = b.floats("SCALAR", 4, &[0.0, 0.5, 1.0, 1.0]);
    b.attribute("_SINEW", painted);
    b.push("nodes", json!({"mesh": 0, "matrix": [1, 0, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 3, 4, 5, 1]}));
    b.json["scenes"] = json!([{"nodes": [0, 1, 3]}]);
    b.json["extensions"] = json!({"VRM": {"secondaryAnimation": {"boneGroups": [{"bones": [1]}]}}});
    b
}

#[test]
fn changed_bytes_never_panic() {
    let original = rich().glb();
    assert!(import_alone("rich.glb", &original).is_ok());
    let mut random = Lcg(1);
    let mut accepted = 0;
    for _ in 0..20_000 {
        let mut bytes = original.clone();
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len());
            // Half of the changes turn a digit into another: numbers stay JSON.
            bytes[at] = match bytes[at] {
                b'0'..=b'9' => b'0' + u8::try_from(random.below(10)).unwrap(),
                other => other ^ (1 << random.below(8)),
            };
        }
        accepted += usize::from(import_alone("rich.glb", &bytes).is_ok());
    }
    assert!((1_000..19_000).contains(&accepted), "{accepted}: the mutations should hit and miss");
}

#[test]
fn changed_numbers_never_panic() {
    let original = String::from_utf8(rich().file()).unwrap();
    let digits: Vec<usize> =
        original.bytes().enumerate().filter(|(_, c)| c.is_ascii_digit()).map(|(i, _)| i).collect();
    let mut random = Lcg(2);
    for _ in 0..5_000 {
        let at = digits[random.below(digits.len())];
        let number =
            ["-1", "4294967295", "18446744073709551615", "1e40", "255", "65536", "null"][random.below(7)];
        let changed = format!("{}{number}{}", &original[..at], &original[at + 1..]);
        let _ = import_alone("rich.gltf", changed.as_bytes());
    }
}
