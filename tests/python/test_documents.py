"""The code of docs/python.md runs as it stands there, from the first block to the last."""

import re
from pathlib import Path


def test_the_blocks_of_the_document_run(examples, monkeypatch, capsys):
    monkeypatch.chdir(examples.parent)
    text = Path("docs/python.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 4
    names = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"docs/python.md, block {number}", "exec"), names)
    said = capsys.readouterr().out
    assert names["estimate"].nodes.shape == (64, 3)
    assert names["pixels"].shape == (64, 2) and names["certain"].any()
    height, width = names["frame"].mask.shape
    inside = (names["pixels"] >= 0).all(axis=1) & (names["pixels"] < (width, height)).all(axis=1)
    assert inside.all()
    assert "no_evidence" in said
