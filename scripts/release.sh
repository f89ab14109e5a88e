#!/usr/bin/env bash
# What is handed out: a program that runs on any x86-64 Linux, packed with its manual page, completions and licences; a
# Debian package; wheels and the sources of the Python package; checksums.
#
#   scripts/release.sh [FOLDER]             into FOLDER [default: release-files in cargo's target folder]
#   PROGRAM=FILE scripts/release.sh …       packs this program instead of building one
#   PARTS="tar deb wheels" …                some of the parts alone
#   MAINTAINER='NAME <ADDRESS>' …           who keeps the Debian package [default: who holds the copyright]
#   SOURCE_DATE_EPOCH=SECONDS …             the time that all files get [default: that of the last commit]
#
# The same sources and the same time give the same bytes. Needs a C compiler for musl (Debian: musl-tools) and dpkg-deb for the
# package; for wheels maturin and zig, taken from PyPI where they are not there. What is missing is said before anything is
# built. A part that cannot be made here is refused with a sentence, and the script then ends with status 3.
set -euo pipefail
# What is named relative to the caller's folder.
here() { [ -z "$1" ] || realpath -m -- "$1"; }
folder=$(here "${1:-}")
program=$(here "${PROGRAM:-}")
[ -z "${CARGO_TARGET_DIR:-}" ] || CARGO_TARGET_DIR=$(here "$CARGO_TARGET_DIR")
cd "$(dirname "$0")/.."
target=x86_64-unknown-linux-musl
parts=${PARTS:-tar deb wheels}
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
holder=$(sed -n 's/^Copyright (c) [0-9]* //p' LICENSE-MIT)
maintainer=${MAINTAINER:-$holder}
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)}
export SOURCE_DATE_EPOCH
umask 022
name=pulloff-$version-x86_64-linux
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
refused=0
refuse() { echo "LEFT OUT: $*" >&2; refused=1; }
wants() { case " $parts " in *" $1 "*) ;; *) return 1 ;; esac; }
has() { command -v "$1" >/dev/null 2>&1; }
missing() { echo "release.sh: $*" >&2; exit 1; }

for part in $parts; do
    case $part in
        tar | deb | wheels) ;;
        *) missing "PARTS has \"$part\", and there are tar, deb and wheels" ;;
    esac
done
if [ -n "$program" ]; then
    [ -x "$program" ] || missing "PROGRAM=$program is no program"
elif wants tar || wants deb; then
    has cargo || missing 'cargo is not here (https://rustup.rs)'
    if [ ! -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
        has rustup || missing "the target $target is not here, and no rustup to add it"
        rustup target add "$target"
    fi
    # The one that the build takes: its variable, or the name that Debian gives it.
    compiler=${CC_x86_64_unknown_linux_musl:-${TARGET_CC:-}}
    if [ -z "$compiler" ]; then
        for known in x86_64-linux-musl-gcc musl-gcc; do
            ! has "$known" || { compiler=$known && break; }
        done
    fi
    has "${compiler:-musl-gcc}" || missing "a C compiler for musl is needed: ${compiler:-musl-gcc} is not here (Debian: musl-tools)"
    # Not every name of it is known to the build.
    export CC_x86_64_unknown_linux_musl=$compiler
fi
if [ -z "$folder" ] || { [ -z "$program" ] && { wants tar || wants deb; }; }; then
    # From the variable or from the settings of cargo.
    targets=$(cargo metadata --locked --no-deps --format-version 1 | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
    folder=${folder:-$targets/release-files}
fi
mkdir -p "$folder"

if { wants tar || wants deb; } && [ -z "$program" ]; then
    cargo build --locked --release --target "$target" -p pulloff
    program=$targets/$target/release/pulloff
    if readelf -d "$program" 2>/dev/null | grep -q NEEDED; then
        echo 'the program needs shared libraries' >&2
        exit 1
    fi
fi

# The tree as it is below /usr, in $1.
stage() {
    local stage=$1
    install -D -m 755 "$program" "$stage/bin/pulloff"
    strip "$stage/bin/pulloff" 2>/dev/null || true
    mkdir -p "$stage/share/man/man1" "$stage/share/bash-completion/completions" \
        "$stage/share/zsh/vendor-completions" "$stage/share/fish/vendor_completions.d" "$stage/share/doc/pulloff"
    # Without the keys that somebody has here.
    local pulloff=(env -i HOME="$work" XDG_CONFIG_HOME="$work/none" "$stage/bin/pulloff")
    "${pulloff[@]}" man >"$stage/share/man/man1/pulloff.1"
    "${pulloff[@]}" completions bash >"$stage/share/bash-completion/completions/pulloff"
    "${pulloff[@]}" completions zsh >"$stage/share/zsh/vendor-completions/_pulloff"
    "${pulloff[@]}" completions fish >"$stage/share/fish/vendor_completions.d/pulloff.fish"
    cp LICENSE-* README.md CHANGELOG.md "$stage/share/doc/pulloff/"
}

# Tries the program with nothing around it but a folder to write into.
try() {
    local root=$work/root
    mkdir -p "$root/out"
    cp "$1" "$root/pulloff"
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
}

# The file that Debian wants: who may do what, with the whole text of each licence that a Debian system does not have.
copyright() {
    cat <<COPYRIGHT
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: pulloff

Files: *
Copyright: $(sed -n 's/^Copyright (c) //p' LICENSE-MIT)
License: Expat or Apache-2.0

License: Expat
$(sed '1,/^Copyright/d' LICENSE-MIT | sed '/./,$!d' | sed 's/^$/./; s/^/ /')

License: Apache-2.0
 On Debian systems the whole text is in /usr/share/common-licenses/Apache-2.0, and in LICENSE-APACHE beside this file.
COPYRIGHT
}

# All files of $1 with the same time and plain permissions.
settled() {
    chmod -R u=rwX,go=rX "$1"
    find "$1" -exec touch --no-dereference --date="@$SOURCE_DATE_EPOCH" {} +
}

if wants tar || wants deb; then
    stage "$work/stage"
    try "$work/stage/bin/pulloff"
fi

if wants tar; then
    settled "$work/stage"
    tar --sort=name --owner=0 --group=0 --numeric-owner --format=gnu --transform "s,^\.,$name," -C "$work/stage" -cf - . |
        gzip -n -9 >"$folder/$name.tar.gz"
fi

if wants deb; then
    if has dpkg-deb; then
        tree=$work/deb
        mkdir -p "$tree/DEBIAN"
        cp -r "$work/stage" "$tree/usr"
        gzip -n -9 "$tree/usr/share/man/man1/pulloff.1"
        copyright >"$tree/usr/share/doc/pulloff/copyright"
        case $maintainer in
            *' <'*@*'>') ;;
            *) echo "the package has no address of its maintainer: MAINTAINER='NAME <ADDRESS>' gives one" >&2 ;;
        esac
        # In units of 1024 bytes, rounded up for each file, whatever the file system says.
        size=$(find "$tree/usr" \( -type f -printf '%s\n' \) -o -printf '1024\n' | awk '{ sum += int(($1 + 1023) / 1024) } END { print sum }')
        cat >"$tree/DEBIAN/control" <<CONTROL
Package: pulloff
Version: $version
Architecture: amd64
Section: science
Priority: optional
Maintainer: $maintainer
Installed-Size: $size
Description: terminal explorer for adhesive contact
 Traces and steps the detachment of rough and smooth spheres: snaps, pull-off, losses.
CONTROL
        settled "$tree"
        # On many cores xz would cut its stream otherwise.
        DPKG_DEB_THREADS_MAX=1 dpkg-deb --root-owner-group -Zxz --build "$tree" "$folder/pulloff_${version}_amd64.deb" >/dev/null
    else
        refuse 'the Debian package: dpkg-deb is not here (Debian: package dpkg)'
    fi
fi

# maturin and zig: those that are there, or of the versions that are written down, from PyPI.
wheel_tools() {
    has maturin && { has zig || python3 -m ziglang version >/dev/null; } 2>/dev/null && return
    python3 -m venv "$work/tools" 2>/dev/null || return 1
    PATH=$work/tools/bin:$PATH
    pip --disable-pip-version-check --quiet install --requirement python/requirements-release.txt 2>/dev/null
}

if wants wheels; then
    if wheel_tools && rustup target add x86_64-unknown-linux-gnu "$target" 2>/dev/null; then
        maturin sdist --manifest-path python/Cargo.toml --out "$folder"
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
