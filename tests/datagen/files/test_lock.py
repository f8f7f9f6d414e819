from __future__ import annotations

import fcntl
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.files.lock import LOCK, locked

ROOT = Path(__file__).parents[3]


def test_a_folder_in_use_is_refused_until_its_holder_dies(tmp_path: Path) -> None:
    script = (
        "import time; from pathlib import Path; from datagen.files.lock import locked\n"
        f"with locked(Path({str(tmp_path)!r})):\n"
        "    print('held', flush=True); time.sleep(60)\n"
    )
    holder = subprocess.Popen([sys.executable, "-c", script], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    with pytest.raises(BadInput, match="another run"), locked(tmp_path):
        pass
    holder.kill()
    holder.wait()
    holder.stdout.close()
    with locked(tmp_path):
        pass


def test_a_run_that_begins_while_another_looks_whether_the_folder_is_held_is_not_refused(tmp_path: Path) -> None:
    look = os.open(tmp_path / LOCK, os.O_RDONLY | os.O_CREAT, 0o644)
    fcntl.flock(look, fcntl.LOCK_SH)
    end_of_look = threading.Timer(0.03, os.close, (look,))
    end_of_look.start()
    with locked(tmp_path):
        end_of_look.join()
