"""Builds the wheel with maturin.

The native module is built for the processor at hand. With STICKSLIP_PROCESSORS=all, for wheels that
travel, a wheel for x86-64 holds it twice: for any such processor, and for those that add a product in
one instruction (x86-64-v3). `stickslip/_native.py` chooses between them.
"""

import json
import os
import platform
import shutil
import subprocess
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import maturin
from maturin import (  # noqa: F401
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

HERE = Path(__file__).resolve().parent.parent
FAST = HERE / "stickslip" / "_x86_64_v3"
FUSED = "x86-64-v3"


def build_wheel(
    wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None
) -> str:
    with flags():
        return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(
    wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None
) -> str:
    with flags():
        return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory: str, config_settings: Any = None) -> str:
    return maturin.build_sdist(sdist_directory, config_settings)


@contextmanager
def flags() -> Iterator[None]:
    """Sets the flags with which maturin builds, and builds the second module if both are asked for.

    With STICKSLIP_PROFILE, a profile of cargo, there is only one, for tests. Its dependencies are
    those that tests of the workspace have compiled, with the flags of .cargo/config.toml.
    """
    (FAST / "_native.abi3.so").unlink(missing_ok=True)
    if profile := os.environ.get("STICKSLIP_PROFILE"):
        os.environ["MATURIN_PEP517_ARGS"] = f"--profile {profile} --features as-tested"
    elif platform.machine().lower() in ("x86_64", "amd64"):
        # With a named target, flags are not for what runs at build time.
        os.environ.setdefault("CARGO_BUILD_TARGET", host())
        processors = os.environ.get("STICKSLIP_PROCESSORS", "here")
        if processors not in ("here", "all"):
            raise SystemExit(f"STICKSLIP_PROCESSORS = {processors}; expected here or all")
        if processors == "all":
            build_fast()
        here = FUSED if processors == "here" and fused_products() else "x86-64"
        # This replaces the flags of .cargo/config.toml.
        os.environ["RUSTFLAGS"] = f"-C target-cpu={here}"
    yield


def fused_products() -> bool:
    """Whether this processor is of FUSED: it has what the compiler would use."""

    def features(processor: str) -> set[str]:
        command = ["rustc", "--print", "cfg", "-C", f"target-cpu={processor}"]
        lines = subprocess.check_output(command, text=True).splitlines()
        return {line for line in lines if line.startswith("target_feature")}

    return features(FUSED) <= features("native")


def host() -> str:
    """The name of this machine's target."""
    lines = subprocess.check_output(["rustc", "-vV"], text=True).splitlines()
    return next(line.removeprefix("host: ") for line in lines if line.startswith("host: "))


def build_fast() -> None:
    """Builds the module for FUSED, beside the one that maturin builds."""
    settings = tomllib.loads((HERE / "pyproject.toml").read_text())["tool"]["maturin"]
    flags = {"RUSTFLAGS": f"-C target-cpu={FUSED}", "PYO3_BUILD_EXTENSION_MODULE": "1"}
    cargo = [
        "cargo",
        "rustc",
        "--profile",
        "python",
        "--locked",
        "--lib",
        "--message-format",
        "json",
    ]
    done = subprocess.run(
        [*cargo, "--manifest-path", str(HERE / settings["manifest-path"])],
        env=os.environ | flags,
        cwd=HERE,
        stdout=subprocess.PIPE,
        check=True,
        text=True,
    )
    messages = map(json.loads, done.stdout.splitlines())
    libraries = [
        name
        for message in messages
        if message["reason"] == "compiler-artifact" and message["target"]["name"] == "_native"
        for name in message["filenames"]
    ]
    FAST.mkdir(exist_ok=True)
    shutil.copy(libraries[0], FAST / "_native.abi3.so")
