"""A policy's graph as the bytes of a file: ONNX, or TorchScript."""

from __future__ import annotations

import contextlib
import io
import logging
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import cast

from dq_marine.agents.deployment.description import METADATA_KEY, PolicyDescription
from dq_marine.agents.deployment.graph import PolicyGraph
from dq_marine.agents.deployment.seal import SEAL_KEY, UNSEALED, sealed
from dq_marine.util.extras import extra_needed

with extra_needed("exporting a policy", "agents"):
    import onnx
    import onnxscript  # noqa: F401 - torch's exporter imports it, and would fail in words of its own
    import torch

OPSET = 18
"""Of ONNX: that which torch's exporter writes without conversion, and every onnxruntime since 1.14 reads."""


def onnx_bytes(graph: PolicyGraph, description: PolicyDescription) -> bytes:
    """Return an ONNX file, its batch axis of any length, with the description in its metadata."""
    batch = torch.export.Dim("batch")
    with _quiet():
        program = torch.onnx.export(
            graph.eval(),
            _examples(graph),
            dynamo=True,
            opset_version=OPSET,
            input_names=list(graph.input_names),
            output_names=list(graph.output_names),
            dynamic_shapes={"given": tuple({0: batch} for _ in graph.input_names)},
            verbose=False,
        )
    model: onnx.ModelProto = cast(torch.onnx.ONNXProgram, program).model_proto
    _forget_sources(model)
    onnx.helper.set_model_props(model, {METADATA_KEY: description.model_dump_json(), SEAL_KEY: UNSEALED})
    onnx.checker.check_model(model, full_check=True)
    return sealed(model.SerializeToString(deterministic=True))


def torchscript_bytes(graph: PolicyGraph, description: PolicyDescription) -> bytes:
    """Return a TorchScript archive with the description among its extra files."""
    content = io.BytesIO()
    with _quiet(), torch.no_grad():
        traced = torch.jit.trace(graph.eval(), _examples(graph))  # type: ignore[no-untyped-call]
        torch.jit.save(traced, content, _extra_files={METADATA_KEY: description.model_dump_json()})
    return content.getvalue()


FORMATS: Mapping[str, Callable[[PolicyGraph, PolicyDescription], bytes]] = {
    ".onnx": onnx_bytes,
    ".pt": torchscript_bytes,
}
"""What writes a file, by the ending of its name."""


def _examples(graph: PolicyGraph) -> tuple[torch.Tensor, ...]:
    """Return observations to trace with; of two, as one would make the batch a constant."""
    return tuple(torch.zeros(2, size) for size in graph.sizes)


def _forget_sources(model: onnx.ModelProto) -> None:
    """Remove what the exporter writes of the program it traced: its files, on this machine, and their lines."""
    parts = (model, model.graph, *model.graph.node, *model.graph.input, *model.graph.output)
    for part in (*parts, *model.graph.value_info, *model.graph.initializer, *model.functions):
        del part.metadata_props[:]
        part.ClearField("doc_string")


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep to itself what torch says of its own parts while it traces: nothing that a user could act on."""
    loggers = [logging.getLogger(name) for name in ("torch.onnx", "torch.export", "onnxscript")]
    before = [one.level for one in loggers]
    try:
        for one in loggers:
            one.setLevel(logging.ERROR)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            warnings.simplefilter("ignore", FutureWarning)
            warnings.filterwarnings(
                "ignore", "# The axis name: batch", UserWarning
            )  # inputs share it, as meant
            yield
    finally:
        for one, level in zip(loggers, before, strict=True):
            one.setLevel(level)
