"""Makes the standalone scripts of this folder importable by its tests, as they are when run by hand."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
