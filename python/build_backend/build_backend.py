"""Builds the wheel with maturin.

On x86-64 a wheel holds the native module twice: built for any such processor, and for those that add
a product in one instruction (x86-64-v3). `stickslip/_native.py` chooses between them.
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


def build_wheel(
    wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None
) -> str:
    with both_builds():
        return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(
    wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None
) -> str:
    with both_builds():
        return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory: str, config_settings: Any = None) -> str:
    return maturin.build_sdist(sdist_directory, config_settings)


@contextmanager
def both_builds() -> Iterator[None]:
    """Builds the faster module; then maturin builds the one for any processor.

    With STICKSLIP_PROFILE, a profile of cargo, there is only one, for tests. Its dependencies are
    those that tests of the workspace have compiled.
    """
    if platform.machine().lower() not in ("x86_64", "amd64"):
        yield
        return
    if profile := os.environ.get("STICKSLIP_PROFILE"):
        # One build, with the flags of .cargo/config.toml.
        os.environ["MATURIN_PEP517_ARGS"] = f"--profile {profile} --features as-tested"
        yield
        return
    settings = tomllib.loads((HERE / "pyproject.toml").read_text())["tool"]["maturin"]
    manifest = HERE / settings["manifest-path"]
    # With a named target, flags are not for what runs at build time, which is then built once.
    os.environ.setdefault("CARGO_BUILD_TARGET", host())
    build_fast(manifest)
    # This replaces the flags of .cargo/config.toml.
    os.environ["RUSTFLAGS"] = "-C target-cpu=x86-64"
    yield


def host() -> str:
    """The name of this machine's target."""
    lines = subprocess.check_output(["rustc", "-vV"], text=True).splitlines()
    return next(line.removeprefix("host: ") for line in lines if line.startswith("host: "))


def build_fast(manifest: Path) -> None:
    flags = {"RUSTFLAGS": "-C target-cpu=x86-64-v3", "PYO3_BUILD_EXTENSION_MODULE": "1"}
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
        [*cargo, "--manifest-path", str(manifest)],
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
