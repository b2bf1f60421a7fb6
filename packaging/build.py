"""Builds what a release hands out for this machine, and tries it: `python packaging/build.py [FOLDER]`.

Into FOLDER (`dist`) go

- the wheel of the Python package, for every processor of this kind,
- its sources as an sdist,
- the program with its licences and completions, as an archive (a zip file on Windows).

Both packages are installed into empty environments, and their program and the archive's have to
compute the same collision. It needs Rust, Python 3.11 and the network, on Linux, macOS and Windows.
For a wheel of Linux that runs elsewhere than here, run it in a container of manylinux.
"""

import os
import platform
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WINDOWS = os.name == "nt"
EXE = ".exe" if WINDOWS else ""
COLLISION = ["collide", "--kappa", "63", "--psi", "0.5", "--format", "json"]
SHELLS = ("bash", "elvish", "fish", "powershell", "zsh")


def run(*command: object, **variables: str) -> str:
    """The standard output of a command, which has to succeed."""
    print("$", *command, flush=True)
    words = [str(word) for word in command]
    environment = os.environ | variables
    return subprocess.run(
        words, cwd=ROOT, env=environment, stdout=subprocess.PIPE, check=True, text=True
    ).stdout


def environment(folder: Path) -> Path:
    """The folder of the commands of a new environment."""
    venv.create(folder, with_pip=True)
    return folder / ("Scripts" if WINDOWS else "bin")


def packages(folder: Path, scratch: Path) -> list[Path]:
    """Builds the wheel and the sdist."""
    commands = environment(scratch / "build")
    run(commands / "python", "-m", "pip", "install", "--quiet", "build")
    built = [commands / "python", "-m", "build", "--outdir", folder, "python"]
    # The second one would otherwise be built from the first.
    for kind in ("--sdist", "--wheel"):
        run(*built, kind, STICKSLIP_PROCESSORS="all")
    return sorted({*folder.glob("*.whl"), *folder.glob("*.tar.gz")} - {*folder.glob("*program*")})


def program(folder: Path, scratch: Path) -> Path:
    """Builds the program for every processor of this kind, and packs it."""
    flags = "-C target-cpu=x86-64" if platform.machine().lower() in ("x86_64", "amd64") else ""
    target = scratch / "target"
    run(
        *("cargo", "build", "--release", "--locked", "--package", "stickslip-cli"),
        CARGO_TARGET_DIR=str(target),
        RUSTFLAGS=flags,
    )
    built = target / "release" / f"stickslip{EXE}"
    _, version, *_ = run(built, "--version").split()
    name = f"stickslip-{version}-program-{platform.system()}-{platform.machine()}".lower()
    packed = scratch / name
    (packed / "completions").mkdir(parents=True)
    shutil.copy(built, packed)
    for file in ("README.md", "CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT", "docs/licences.md"):
        shutil.copy(ROOT / file, packed)
    for shell in SHELLS:
        completions = run(built, "completions", shell)
        (packed / "completions" / f"stickslip.{shell}").write_text(completions, encoding="utf-8")
    archive = shutil.make_archive(
        str(folder / name), "zip" if WINDOWS else "gztar", scratch, name
    )
    return Path(archive)


def tried(package: Path, scratch: Path) -> str:
    """What the program of a package, installed into an empty environment, says of a collision."""
    commands = environment(scratch / package.name)
    run(commands / "python", "-m", "pip", "install", "--quiet", package)
    print(run(commands / f"stickslip{EXE}", "--version").splitlines()[0], "from", package.name)
    run(commands / "python", "-c", "import stickslip; assert stickslip.collide(63, 0.5).switch_count == 6")
    return run(commands / f"stickslip{EXE}", *COLLISION, STICKSLIP_PORTABLE="1")


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        sys.exit(f"{folder} is not empty; expected a new folder")
    with tempfile.TemporaryDirectory() as temporary:
        scratch = Path(temporary)
        archive = program(folder, scratch)
        wheel_and_sdist = packages(folder, scratch)
        shutil.unpack_archive(archive, scratch / "unpacked")
        unpacked = next((scratch / "unpacked").iterdir()) / f"stickslip{EXE}"
        wanted = run(unpacked, *COLLISION)
        for package in wheel_and_sdist:
            # From the sdist it is built for the processor at hand, so that last digits may differ.
            same = tried(package, scratch) == wanted
            if not same and package.suffix == ".whl":
                sys.exit(f"{package.name} computes another collision than {archive.name}")
    for path in sorted(folder.iterdir()):
        print(f"{path.stat().st_size / 1e6:7.1f} MB  {path.name}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "dist").resolve())
