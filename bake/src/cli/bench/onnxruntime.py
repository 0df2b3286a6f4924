"""Times onnxruntime on one thread: `small`, 96-64-64-48 at batch 1, or `large`, 24576 x 16384 times a vector.

Prints `name: ms`. Small networks are timed 64 in a graph, so that the call from Python does not count.
"""
import sys, tempfile, time
from pathlib import Path
import numpy as np, onnx, onnxruntime
from onnx import TensorProto, helper, numpy_helper
from onnxruntime.quantization import QuantType, quantize_dynamic

onnxruntime.set_default_logger_severity(3)
sizes, copies = {"small": ([96, 64, 64, 48], 64), "large": ([16384, 24576], 1)}[sys.argv[1]]
rng = np.random.default_rng(1)
weights = [rng.standard_normal(shape, dtype=np.float32) / 64 for shape in zip(sizes, sizes[1:])]
initializers = [numpy_helper.from_array(w, f"w{i}") for i, w in enumerate(weights)]
initializers += [numpy_helper.from_array(np.zeros(w.shape[1], np.float32), f"b{i}") for i, w in enumerate(weights)]
nodes, inputs, outputs = [], [], []
for copy in range(copies):
    name = f"x{copy}"
    inputs.append(helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, sizes[0]]))
    for i in range(len(weights)):
        last = i + 1 == len(weights)
        product, out = f"{copy}m{i}", f"{copy}y{i}"
        nodes.append(helper.make_node("MatMul", [name, f"w{i}"], [product]))
        nodes.append(helper.make_node("Add", [product, f"b{i}"], [out]))
        name = out
        if not last:
            nodes.append(helper.make_node("Relu", [out], [f"{copy}a{i}"]))
            name = f"{copy}a{i}"
    outputs.append(helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, sizes[-1]]))
graph = helper.make_graph(nodes, "mlp", inputs, outputs, initializers)
model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)])
model.ir_version = 8
options = onnxruntime.SessionOptions()
options.intra_op_num_threads = options.inter_op_num_threads = 1
with tempfile.TemporaryDirectory() as folder:
    plain, quantized = Path(folder) / "f32.onnx", Path(folder) / "int8.onnx"
    onnx.save(model, plain)
    quantize_dynamic(plain, quantized, weight_type=QuantType.QInt8, per_channel=True)
    for name, path in (("onnxruntime int8", quantized), ("onnxruntime f32", plain)):
        session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
        feed = {f"x{copy}": rng.standard_normal((1, sizes[0]), dtype=np.float32) for copy in range(copies)}
        best = float("inf")
        for _ in range(60 if copies > 1 else 10):
            start = time.perf_counter()
            session.run(None, feed)
            best = min(best, time.perf_counter() - start)
        print(f"{name}: {1e3 * best / copies}")
