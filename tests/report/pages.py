"""Pages as users make them, each made once for all test processes."""

from __future__ import annotations

import fcntl
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from places import FIXTURES
from rig import campaign, noisy

from erdctl.core.recording import Recording

ERDCTL = [sys.executable, "-m", "erdctl"]
FEW = "coulomb_friction"  # so that a diagnosis takes seconds
TABLE_2 = str(FIXTURES / "table_2.json")
RUBBING = 2.5  # N
# Names that would be markup if a page took them for it.
EVIL_FILE = "rub <img src=x onerror=alert(1)>.csv"
EVIL_RECORD = "</script><script>document.title='taken'</script>"
MAPS = ["t=Zeit[ms]", "x=Hub<b>[mm]", "xdot=Hub/dt[mm/s]", "duty=PWM[%]", "force=F_fl[N]"]
FOREIGN = ["t=Time[ms]", "x=Defl FL[mm]", "force=F_fl[N]", "duty=PWM[%]"]
FAULTS = ["oil=0.2@15:31", "electrical=0.8@31:46"]

HEALTHY = {
    "campaign": "healthy_campaign.parquet",
    "noisy_motion": "healthy_noisy_motion.csv",
    "schedule": "schedule_60s.csv",
    "hot": "schedule_hot.csv",
}
# What was hidden in a log, and what the first screen must name.
CONCEALED = {
    "late": ("late_amplifier.parquet", "input_delay", "input delay"),
    "worn": ("worn_joint.parquet", "backlash", "backlash"),
}
NAMES = (*HEALTHY, *CONCEALED, "rubbing", "validation", "foreign", "mimic", "proof")


def page(name: str, folder: Path) -> Path:
    """The page of that name in a folder that several processes may share."""
    path = folder / f"{name}.html"
    with (folder / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not path.exists():
            words = _words(name, folder)
            erdctl(*words, "--report", str(path)) if words else _proof(path)
    return path


def erdctl(*words: str, code: int = 0) -> str:
    run = subprocess.run([*ERDCTL, *words], capture_output=True, text=True)
    assert run.returncode == code, run.stderr
    return run.stderr


def _words(name: str, folder: Path) -> list[str]:
    """The command line of a page; none for that of the proof."""
    out = ["-o", str(folder / f"{name}.out.json")]
    if name in HEALTHY:
        return ["diagnose", str(FIXTURES / HEALTHY[name]), "--effects", FEW, "--jobs", "1", *out]
    if name in CONCEALED:
        log, effect, _ = CONCEALED[name]
        few = ["--effects", f"{FEW},{effect}", "--jobs", "1"]
        return ["diagnose", str(FIXTURES / log), *few, *out]
    if name == "rubbing":
        log = rubbing(folder)
        few = ["--effects", f"{FEW},backlash,force_drift", "--seed", "3", "--jobs", "1"]
        return ["diagnose", str(log), *mapped(MAPS), *few, *out]
    if name == "validation":
        params = folder / "damper.json"
        erdctl("identify", str(FIXTURES / "healthy_campaign.parquet"), "-o", str(params))
        return ["validate", str(params), str(FIXTURES / "healthy_campaign.parquet")]
    if name == "foreign":
        return ["validate", TABLE_2, str(FIXTURES / "foreign.csv"), *mapped(FOREIGN)]
    if name == "mimic":
        faults = [word for fault in FAULTS for word in ("--fault", fault)]
        schedule = str(FIXTURES / "schedule_60s.csv")
        return ["mimic", TABLE_2, schedule, *faults, "-o", str(folder / "pwm.csv")]
    return []


def mapped(maps: list[str]) -> list[str]:
    return [word for m in maps for word in ("--map", m)]


def concealed() -> Recording:
    """Seal friction of RUBBING newton added to the exact model, with 0.3 N of noise."""
    clean = campaign(duration=4.0)
    assert clean.force is not None
    force = clean.force + RUBBING * np.sign(clean.xdot)
    return noisy(replace(clean, force=force), seed=5)


def rubbing(folder: Path) -> Path:
    """That log as a laboratory would write it, with hostile names."""
    r = concealed()
    record = np.repeat([f"{EVIL_RECORD}{name}" for name in r.names], np.diff(r.starts))
    columns = {"Zeit": 1e3 * r.t, "Hub<b>": 1e3 * r.x, "Hub/dt": 1e3 * r.xdot}
    columns |= {"PWM": 100 * r.duty, "F_fl": r.force, "record": record}
    path = folder / EVIL_FILE
    pd.DataFrame(columns).to_csv(path, index=False)
    return path


def _proof(path: Path) -> None:
    """A made-up scoreboard: running one takes longer than all other pages together."""
    from dataclasses import asdict

    from results import result

    from erdctl.prove.case import Wish
    from erdctl.prove.document import proof_of, to_json
    from erdctl.prove.score import Found, HiddenEffect
    from erdctl.prove.tables import tables
    from erdctl.report.page.proof import proof_page
    from erdctl.report.page.render import Run

    missed = {"findings": (Found("other"),), "named": False, "spurious": 1, "matched": 0}
    null = {"hidden": (), "kind": "null", "named": None, "findings": (), "verdict": "adequate"}
    outcomes = [
        result(seed=7), result(seed=8, level=1.2, hidden=(HiddenEffect("rub", 1.2),)),
        result(seed=9, **missed), result(seed=10, **null, level=0.0, located=None),
    ]  # fmt: skip
    proof = proof_of(Wish(), range(7, 11), outcomes)
    assert asdict(proof)["cases"] == 4
    made = proof_page(to_json(proof), list(tables(proof.summary)), run=Run(words=["prove"]))
    path.write_text(made)
