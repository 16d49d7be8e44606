#!/usr/bin/env python3
"""Make a release archive: a statically linked binary with completions, manual pages and licences.

    scripts/release.py [--target TRIPLE] [--out DIR]

The archive is DIR/carom-VERSION-TRIPLE.tar.gz (default: target/release-archives), and its SHA-256
is added to DIR/SHA256SUMS. Without --target the host's triple is used; on Linux with glibc the C
library is linked statically, so that the binary runs on any distribution. Other targets need
`rustup target add TRIPLE` (for example x86_64-unknown-linux-musl) and a linker for them.
"""

import argparse
import hashlib
import os
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILES = ["README.md", "CHANGELOG.md", "CITATION.cff", "LICENSE-MIT", "LICENSE-APACHE"]
SHELLS = {"bash": "carom.bash", "zsh": "_carom", "fish": "carom.fish", "powershell": "carom.ps1"}


def host() -> str:
    """Triple of the host."""
    lines = subprocess.run(["rustc", "-vV"], check=True, capture_output=True, text=True).stdout
    return next(line.split()[1] for line in lines.splitlines() if line.startswith("host:"))


def build(triple: str) -> pathlib.Path:
    """The binary, linked statically."""
    where = subprocess.run(["rustc", "--print", "target-libdir", "--target", triple], capture_output=True, text=True, check=False)
    if where.returncode != 0:
        sys.exit(where.stderr.strip())
    if not pathlib.Path(where.stdout.strip()).is_dir():
        sys.exit(f"the standard library of {triple} is not installed: `rustup target add {triple}`, which needs the network")
    flags = f"{os.environ.get('RUSTFLAGS', '')} -C target-feature=+crt-static".strip()
    # Assertions are for developers; a release does without them.
    profile = {"CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS": "false", "CARGO_PROFILE_RELEASE_LTO": "thin"}
    command = ["cargo", "build", "--release", "--locked", "--target", triple, "--bin", "carom", "--features", "carom/parquet,carom/figures"]
    subprocess.run(command, check=True, cwd=ROOT, env={**os.environ, **profile, "RUSTFLAGS": flags})
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    name = "carom.exe" if "windows" in triple else "carom"
    return target / triple / "release" / name


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    options.add_argument("--target", default=host())
    options.add_argument("--out", type=pathlib.Path, default=ROOT / "target/release-archives")
    given = options.parse_args()
    version = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]
    binary = build(given.target)
    name = f"carom-{version}-{given.target}"
    given.out.mkdir(parents=True, exist_ok=True)
    archive = given.out / f"{name}.tar.gz"
    with tempfile.TemporaryDirectory() as place, tarfile.open(archive, "w:gz") as tar:
        tar.add(binary, f"{name}/{binary.name}")
        for file in FILES:
            tar.add(ROOT / file, f"{name}/{file}")
        # Completions and manual pages come from the binary itself, where the host can run it.
        if given.target == host():
            scripts = pathlib.Path(place) / "completions"
            scripts.mkdir()
            for shell, file in SHELLS.items():
                done = subprocess.run([binary, "completions", shell], check=True, capture_output=True)
                (scripts / file).write_bytes(done.stdout)
            subprocess.run([binary, "man", "--out", pathlib.Path(place) / "man"], check=True)
            tar.add(scripts, f"{name}/completions")
            tar.add(pathlib.Path(place) / "man", f"{name}/man")
    digest = hashlib.sha256(archive.read_bytes()).hexdigest()
    sums = given.out / "SHA256SUMS"
    others = [line for line in sums.read_text().splitlines() if not line.endswith(archive.name)] if sums.exists() else []
    sums.write_text("\n".join([*others, f"{digest}  {archive.name}"]) + "\n", encoding="utf-8")
    print(f"{archive}\n{digest}")


if __name__ == "__main__":
    main()
