//! Every form that glTF allows, on a square with two joints.

use serde_json::json;
use sinew_bake::model::{Interpolation, Primitive, Property};

use crate::builder::{Builder, F32, I8, I16, SQUARE, U8, U16, U32, import_alone, square};

fn only_primitive(builder: &Builder) -> Primitive {
    let mut model = builder.import().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(model.primitives.len(), 1, "one primitive");
    model.primitives.remove(0)
}

/// Positions of a primitive, flattened.
fn flat(primitive: &Primitive) -> &[f32] {
    primitive.positions.as_flattened()
}

#[test]
fn text_and_binary_containers_are_the_same() {
    let b = square();
    let text = import_alone("same.gltf", &b.file()).unwrap();
    let binary = import_alone("same.glb", &b.glb()).unwrap();
    let with_mark = import_alone("same.gltf", &[b"\xEF\xBB\xBF", b.file().as_slice()].concat()).unwrap();
    assert_eq!(text.primitives, binary.primitives);
    assert_eq!(text.primitives, with_mark.primitives);
    assert_eq!(flat(&text.primitives[0]), SQUARE);
    assert_eq!(text.primitives[0].joints[8], 1);
}

#[test]
fn buffer_names_reach_the_caller_decoded() {
    let b = square();
    let mut json = b.json.clone();
    json["buffers"] = json!([{"byteLength": b.bytes.len(), "uri": "my%20folder/a.bin"}]);
    let mut asked = String::new();
    let file = serde_json::to_vec(&json).unwrap();
    let model = sinew_bake::import::import_bytes("x.gltf", &file, &mut |uri| {
        asked = uri.to_owned();
        Ok(b.bytes.clone())
    });
    assert_eq!(model.unwrap().vertex_count(), 4);
    assert_eq!(asked, "my folder/a.bin");
}

#[test]
fn normalized_weights_become_shares() {
    let mut b = square();
    let weights = b.accessor(&[51, 204, 0, 0].repeat(4), U8, "VEC4", 4, true);
    let joints = b.bytes("VEC4", 4, &[0, 1, 0, 0].repeat(4));
    b.attribute("WEIGHTS_0", weights);
    b.attribute("JOINTS_0", joints);
    let p = only_primitive(&b);
    assert_eq!((&p.joints[..2], &p.weights[..4]), (&[1, 0][..], &[0.8, 0.2, 0.0, 0.0][..]));

    let shorts: Vec<u8> = [16_384_u16, 49_151, 0, 0].repeat(4).iter().flat_map(|w| w.to_le_bytes()).collect();
    let weights = b.accessor(&shorts, U16, "VEC4", 4, true);
    b.attribute("WEIGHTS_0", weights);
    let p = only_primitive(&b);
    assert_eq!(&p.joints[..2], [1, 0]);
    assert!((p.weights[0] - 0.75).abs() < 1e-4 && (p.weights[0] + p.weights[1] - 1.0).abs() < 1e-6);
}

#[test]
fn quantized_positions_and_normals_are_converted() {
    const MAX: i16 = i16::MAX;
    const LOW: i16 = i16::MIN;
    let mut b = square();
    b.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    // The fourth number is padding.
    let corners = [[0, 0, LOW, 0], [MAX, 0, LOW, 0], [MAX, MAX, LOW, 0], [0, MAX, LOW, 0]];
    let corners: Vec<u8> = corners.into_iter().flatten().flat_map(i16::to_le_bytes).collect();
    let positions = b.accessor(&corners, I16, "VEC3", 4, true);
    b.json["bufferViews"][4]["byteStride"] = json!(8);
    b.attribute("POSITION", positions);
    let normals = b.accessor(&[0, 0, 129, 0].repeat(4), I8, "VEC3", 4, true);
    b.json["bufferViews"][5]["byteStride"] = json!(4);
    b.attribute("NORMAL", normals);
    let p = only_primitive(&b);
    assert_eq!(p.positions[2], [1.0, 1.0, -1.0], "-32768 counts as -1");
    assert_eq!(p.normals, [[0.0, 0.0, -1.0]; 4]);
}

#[test]
fn plain_integers_are_not_scaled() {
    let mut b = square();
    let corners = [[0, 0, 0], [200, 0, 0], [200, 200, 0], [0, 200, 0]].concat();
    let positions = b.accessor(&corners, U8, "VEC3", 4, false);
    b.attribute("POSITION", positions);
    assert_eq!(only_primitive(&b).positions[2], [200.0, 200.0, 0.0]);
}

#[test]
fn sparse_entries_replace_elements() {
    let mut b = square();
    let rows = b.view(&3_u16.to_le_bytes());
    let values = b.view(&[5.0_f32, 6.0, 7.0].map(f32::to_le_bytes).concat());
    let sparse = json!({"count": 1, "indices": {"bufferView": rows, "componentType": U16}, "values": {"bufferView": values}});
    b.json["accessors"][0]["sparse"] = sparse.clone();
    let p = only_primitive(&b);
    assert_eq!(p.positions[3], [5.0, 6.0, 7.0]);
    assert_eq!(p.positions[2], [1.0, 1.0, 0.0]);
    // Without a buffer view the other elements are 0.
    let accessor =
        b.push("accessors", json!({"componentType": F32, "type": "VEC3", "count": 4, "sparse": sparse}));
    b.attribute("POSITION", accessor);
    assert_eq!(flat(&only_primitive(&b)), [0., 0., 0., 0., 0., 0., 0., 0., 0., 5., 6., 7.]);
}

#[test]
fn modes_become_triangles_and_points_and_lines_are_skipped() {
    let mut b = square();
    let set = |b: &mut Builder, mode: u32| {
        b.json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        b.json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    };
    set(&mut b, 5);
    assert_eq!(only_primitive(&b).indices, [[0, 1, 2], [2, 1, 3]]);
    set(&mut b, 6);
    assert_eq!(only_primitive(&b).indices, [[0, 1, 2], [0, 2, 3]]);
    set(&mut b, 4);
    assert_eq!(only_primitive(&b).indices, [[0, 1, 2]], "an incomplete triangle is dropped");
    for mode in 0..4 {
        set(&mut b, mode);
        assert!(b.refused().contains("no mesh has a skin"));
    }
    // A strip joined by a triangle without area keeps its winding.
    set(&mut b, 5);
    let indices = b.accessor(&[0_u32, 1, 2, 2, 3].map(u32::to_le_bytes).concat(), U32, "SCALAR", 5, false);
    b.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    assert_eq!(only_primitive(&b).indices, [[0, 1, 2]]);
}

#[test]
fn eight_influences_widen_the_stride_only_where_needed() {
    let mut b = square();
    let eighth = b.floats("VEC4", 4, &[0.125; 16]);
    let joints_0 = b.bytes("VEC4", 4, &[0, 1, 2, 3].repeat(4));
    let joints_1 = b.bytes("VEC4", 4, &[4, 5, 6, 7].repeat(4));
    for _ in 0..6 {
        b.push("nodes", json!({}));
    }
    b.json["skins"][0]["joints"] = json!([1, 2, 3, 4, 5, 6, 7, 8]);
    for (name, accessor) in
        [("WEIGHTS_0", eighth), ("WEIGHTS_1", eighth), ("JOINTS_0", joints_0), ("JOINTS_1", joints_1)]
    {
        b.attribute(name, accessor);
    }
    let p = only_primitive(&b);
    assert_eq!(
        (p.stride, &p.joints[..8], &p.weights[..8]),
        (8, &[0, 1, 2, 3, 4, 5, 6, 7][..], &[0.125; 8][..])
    );
    let nothing = b.floats("VEC4", 4, &[0.0; 16]);
    b.attribute("WEIGHTS_1", nothing);
    let p = only_primitive(&b);
    assert_eq!((p.stride, &p.weights[..4]), (4, &[0.25; 4][..]));
}

#[test]
fn missing_normals_are_computed_and_bad_ones_replaced() {
    let mut b = square();
    assert_eq!(only_primitive(&b).normals, [[0.0, 0.0, 1.0]; 4]);
    let normals = b.floats("VEC3", 4, &[0., 3., 4., 0., 0., 0., f32::NAN, 0., 0., 1., 0., 0.]);
    b.attribute("NORMAL", normals);
    assert_eq!(
        only_primitive(&b).normals,
        [[0.0, 0.6, 0.8], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    );
}

#[test]
fn painted_softness_is_read_in_all_its_forms() {
    let mut b = square();
    assert_eq!(only_primitive(&b).painted, None);
    let floats = b.floats("SCALAR", 4, &[0.0, 0.5, 1.0, 3.0]);
    b.attribute("_SINEW", floats);
    assert_eq!(only_primitive(&b).painted.unwrap(), [0.0, 0.5, 1.0, 1.0]);
    let colors = b.accessor(&[255, 0, 0, 255, 51, 0, 0, 255].repeat(2), U8, "VEC4", 4, true);
    b.attribute("_SINEW", colors);
    assert_eq!(only_primitive(&b).painted.unwrap(), [1.0, 0.2, 1.0, 0.2]);
}

#[test]
fn skins_share_joints_where_node_and_matrix_agree() {
    let mut b = square();
    let shifted = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 5., 0., 1.];
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let matrices = b.floats("MAT4", 2, &[identity, shifted].concat());
    b.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": matrices}));
    b.push("nodes", json!({"mesh": 0, "skin": 1, "scale": [-2, 1, 1]}));
    let model = b.import().unwrap();
    assert_eq!(model.joints.iter().map(|j| j.node).collect::<Vec<_>>(), [1, 2, 2]);
    assert_eq!(model.joints[2].joint_from_bind.w_axis.y, 5.0);
    let ids: Vec<_> = model.primitives.iter().map(|p| (p.node, p.mesh, p.primitive)).collect();
    assert_eq!(ids, [(0, 0, 0), (3, 0, 0)], "one mesh, two skinned nodes");
    assert_eq!([model.primitives[0].joints[8], model.primitives[1].joints[8]], [1, 2]);
    assert_eq!(model.primitives[1].joints[0], 0);
    assert_eq!(model.nodes[3].scale.x, -2.0);
}

#[test]
fn meshes_without_skin_are_rigid_and_hidden_scenes_stay_out() {
    let mut b = square();
    b.push("nodes", json!({"mesh": 0}));
    let model = b.import().unwrap();
    assert_eq!(model.rigid.iter().map(|r| r.node).collect::<Vec<_>>(), [3]);
    b.json["scenes"] = json!([{"nodes": [3]}, {"nodes": [0]}]);
    b.json["scene"] = json!(1);
    let model = b.import().unwrap();
    assert_eq!((model.primitives.len(), model.rigid.len(), model.nodes.len()), (1, 0, 4));
}

#[test]
fn node_matrices_are_decomposed() {
    let mut b = square();
    // Mirrored in z, doubled in y, turned a quarter about x, shifted.
    b.push("nodes", json!({"matrix": [1, 0, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 3, 4, 5, 1]}));
    b.push("nodes", json!({"matrix": [0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}));
    b.push("nodes", json!({"rotation": [0, 0, 0, 2]}));
    let model = b.import().unwrap();
    let columns = model.nodes[3].parent_from_node().to_cols_array();
    let expected = [1., 0., 0., 0., 0., 0., 2., 0., 0., 1., 0., 0., 3., 4., 5., 1.];
    assert!(columns.iter().zip(expected).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-12), "{columns:?}");
    assert_eq!(model.nodes[4].scale.x, 0.0);
    assert!(model.nodes[4].rotation.is_normalized() && model.nodes[5].rotation.is_normalized());
}

#[test]
fn materials_bring_color_texture_and_coordinates() {
    let mut b = square();
    let png = b.view(b"\x89PNG rest");
    b.json["images"] = json!([{"bufferView": png, "mimeType": "image/png"}, {"uri": "data:;base64,/9j/AA"}, {"uri": "gone.png"}]);
    b.json["textures"] = json!([{"source": 0}, {"source": 1}, {"source": 2}, {}]);
    for texture in 0..4 {
        let info = json!({"index": texture, "texCoord": 1});
        b.push(
            "materials",
            json!({"doubleSided": true, "pbrMetallicRoughness": {
            "baseColorFactor": [0.5, 0.25, 1, 1], "baseColorTexture": info}}),
        );
    }
    b.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let uvs = b.floats("VEC2", 4, &[0., 0., 1., 0., 1., 1., 0., 1.]);
    b.attribute("TEXCOORD_1", uvs);
    let transform = json!({"KHR_texture_transform": {"offset": [0.5, 0], "scale": [2, 1]}});
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = transform;
    let model = b.import().unwrap();
    assert_eq!(model.materials[0].base_color, [0.5, 0.25, 1.0, 1.0]);
    assert!(model.materials[0].double_sided);
    let textures: Vec<_> = model.materials.iter().map(|m| m.texture.as_deref()).collect();
    assert_eq!(textures, [Some(&b"\x89PNG rest"[..]), Some(&[0xFF, 0xD8, 0xFF, 0x00][..]), None, None]);
    assert_eq!(model.primitives[0].material, Some(0));
    assert_eq!(model.primitives[0].uvs[2], [2.5, 1.0], "set 1, scaled and shifted");
}

#[test]
fn channels_of_all_kinds_are_read() {
    let mut b = square();
    let times = b.floats("SCALAR", 2, &[0.5, 2.0]);
    let moves = b.floats("VEC3", 2, &[0., 0., 0., 1., 2., 3.]);
    let turns = b.accessor(&[0, 0, 0, 127, 0, 0, 127, 0], I8, "VEC4", 2, true);
    let cubic = b.floats("VEC3", 6, &[1.0; 18]);
    let weights = b.floats("SCALAR", 2, &[0., 1.]);
    let channel =
        |sampler: usize, path: &str| json!({"sampler": sampler, "target": {"node": 2, "path": path}});
    let animation = json!({
        "samplers": [
            {"input": times, "output": moves}, {"input": times, "output": turns, "interpolation": "STEP"},
            {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"}, {"input": times, "output": weights},
        ],
        "channels": [channel(0, "translation"), channel(1, "rotation"), channel(2, "scale"), channel(3, "weights"),
            {"sampler": 3, "target": {"path": "pointer"}}],
    });
    b.push("animations", animation);
    let model = b.import().unwrap();
    let clip = &model.clips[0];
    assert_eq!((clip.name.as_str(), clip.duration), ("clip 0", 2.0));
    let kinds: Vec<_> = clip.channels.iter().map(|c| (c.property, c.interpolation, c.values.len())).collect();
    assert_eq!(
        kinds,
        [
            (Property::Translation, Interpolation::Linear, 6),
            (Property::Rotation, Interpolation::Step, 8),
            (Property::Scale, Interpolation::CubicSpline, 18),
        ]
    );
    assert_eq!(clip.channels[1].values, [0., 0., 0., 1., 0., 0., 1., 0.]);
    assert_eq!((clip.channels[0].node, clip.channels[0].times.as_slice()), (2, &[0.5, 2.0][..]));
}

#[test]
fn channels_without_keys_and_values_without_key_are_dropped() {
    let mut b = square();
    let none = b.floats("SCALAR", 0, &[]);
    let one = b.floats("SCALAR", 1, &[0.5]);
    let moves = b.floats("VEC3", 2, &[1., 2., 3., 4., 5., 6.]);
    let channel =
        |sampler: usize, path: &str| json!({"sampler": sampler, "target": {"node": 2, "path": path}});
    let animation = json!({
        "name": "still",
        "samplers": [{"input": none, "output": moves}, {"input": one, "output": moves}],
        "channels": [channel(0, "scale"), channel(1, "translation")],
    });
    b.push("animations", animation);
    let model = b.import().unwrap();
    let clip = &model.clips[0];
    assert_eq!((clip.name.as_str(), clip.duration, clip.channels.len()), ("still", 0.5, 1));
    assert_eq!(clip.channels[0].values, [1.0, 2.0, 3.0]);
}

#[test]
fn cameras_lights_and_odd_skeleton_roots_are_no_obstacle() {
    let mut b = square();
    b.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]);
    b.push("nodes", json!({"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 7}}}));
    b.json["skins"][0]["skeleton"] = json!(3);
    b.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 0}]);
    let model = b.import().unwrap();
    assert!(model.primitives[0].morphs);
    assert_eq!(model.vrm, None);
}
