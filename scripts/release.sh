#!/usr/bin/env bash
# What is handed out: a program that runs on any x86-64 Linux, packed with its manual page, completions and licences; a
# Debian package; wheels; checksums.
#
#   scripts/release.sh [FOLDER]             into FOLDER [default: target/release-files]
#   PROGRAM=FILE scripts/release.sh …       packs this program instead of building one
#   PARTS="tar deb wheels" …                some of the parts alone
#   MAINTAINER='NAME <ADDRESS>' …            who keeps the Debian package [default: who holds the copyright]
#
# Needs a C compiler for musl (Debian: musl-tools) and dpkg-deb for the package; for wheels maturin and zig, taken from PyPI
# where they are not there. A part that cannot be made here is refused with a sentence, and the script then ends with status 3.
set -euo pipefail
cd "$(dirname "$0")/.."
target=x86_64-unknown-linux-musl
folder=$(realpath -m "${1:-target/release-files}")
parts=${PARTS:-tar deb wheels}
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
maintainer=${MAINTAINER:-$(sed -n 's/^Copyright (c) [0-9]* //p' LICENSE-MIT)}
name=pulloff-$version-x86_64-linux
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
refused=0
refuse() { echo "LEFT OUT: $*" >&2; refused=1; }
wants() { case " $parts " in *" $1 "*) ;; *) return 1 ;; esac; }

mkdir -p "$folder"
program=${PROGRAM:-}
if [ -z "$program" ]; then
    if [ ! -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
        rustup target add "$target"
    fi
    cargo build --locked --release --target "$target" -p pulloff
    program=target/$target/release/pulloff
    if readelf -d "$program" 2>/dev/null | grep -q NEEDED; then
        echo 'the program needs shared libraries' >&2
        exit 1
    fi
fi

# The staged tree, as it is below /usr.
stage=$work/stage
install -D -m 755 "$program" "$stage/bin/pulloff"
strip "$stage/bin/pulloff" 2>/dev/null || true
pulloff=$stage/bin/pulloff
mkdir -p "$stage/share/man/man1" "$stage/share/bash-completion/completions" "$stage/share/zsh/vendor-completions" \
    "$stage/share/fish/vendor_completions.d" "$stage/share/doc/pulloff"
"$pulloff" man >"$stage/share/man/man1/pulloff.1"
"$pulloff" completions bash >"$stage/share/bash-completion/completions/pulloff"
"$pulloff" completions zsh >"$stage/share/zsh/vendor-completions/_pulloff"
"$pulloff" completions fish >"$stage/share/fish/vendor_completions.d/pulloff.fish"
cp LICENSE-* README.md CHANGELOG.md "$stage/share/doc/pulloff/"

# Tried with nothing around it but a folder to write into.
root=$work/root
mkdir -p "$root/out"
cp "$pulloff" "$root/pulloff"
inside() { unshare --root="$root" --map-root-user --wd=/ "$@"; }
if [ -n "${PROGRAM:-}" ] || ! inside /pulloff --version >/dev/null 2>&1; then
    echo 'the program is tried where it stands, not in a root of its own'
    inside() { (cd "$root" && exec ".$1" "${@:2}"); }
fi
inside /pulloff unload wavy-sphere | tail -n 3
inside /pulloff plot wavy-sphere -o out/curve.png
if [ "$(head -c 4 "$root/out/curve.png" | tail -c 3)" != PNG ]; then
    echo 'no PNG was made' >&2
    exit 1
fi

if wants tar; then
    # The same bytes for the same files.
    tar --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 --transform "s,^\.,$name," -C "$stage" -cf - . |
        gzip -n -9 >"$folder/$name.tar.gz"
fi

if wants deb; then
    if command -v dpkg-deb >/dev/null; then
        tree=$work/deb
        mkdir -p "$tree/DEBIAN"
        cp -r "$stage" "$tree/usr"
        gzip -n -9 "$tree/usr/share/man/man1/pulloff.1"
        cat >"$tree/DEBIAN/control" <<CONTROL
Package: pulloff
Version: $version
Architecture: amd64
Section: science
Priority: optional
Maintainer: $maintainer
Installed-Size: $(du -sk "$tree/usr" | cut -f 1)
Description: terminal explorer for adhesive contact
 Traces and steps the detachment of rough and smooth spheres: snaps, pull-off, losses.
CONTROL
        chmod -R u=rwX,go=rX "$tree"
        dpkg-deb --root-owner-group --build "$tree" "$folder/pulloff_${version}_amd64.deb" >/dev/null
    else
        refuse 'the Debian package: dpkg-deb is not here (Debian: package dpkg)'
    fi
fi

# maturin and zig: those that are there, or of the versions that are written down, from PyPI.
wheel_tools() {
    command -v maturin >/dev/null && { command -v zig >/dev/null || python3 -m ziglang version >/dev/null; } 2>/dev/null && return
    python3 -m venv "$work/tools" 2>/dev/null || return 1
    PATH=$work/tools/bin:$PATH
    pip --disable-pip-version-check --quiet install --requirement python/requirements-release.txt 2>/dev/null
}

if wants wheels; then
    if wheel_tools && rustup target add x86_64-unknown-linux-gnu "$target" 2>/dev/null; then
        for compatibility in manylinux2014 musllinux_1_2; do
            libc=gnu
            [ "$compatibility" = musllinux_1_2 ] && libc=musl
            maturin build --release --zig --compatibility "$compatibility" --target "x86_64-unknown-linux-$libc" \
                --manifest-path python/Cargo.toml --out "$folder"
        done
    else
        refuse 'the wheels: maturin and zig are needed for them (PyPI: maturin, ziglang), and the target for musl'
    fi
fi

(cd "$folder" && find . -maxdepth 1 -type f \( -name '*.tar.gz' -o -name '*.deb' -o -name '*.whl' \) -printf '%P\n' | sort |
    xargs -r sha256sum >SHA256SUMS)
cat "$folder/SHA256SUMS"
[ "$refused" = 0 ] || exit 3
