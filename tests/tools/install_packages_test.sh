#!/bin/sh
# tools/install_packages with stand-ins for dpkg-query and apt-get, which keep their packages in files: nothing is
# installed.
set -eu
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$root/tests/tools/expect.sh"

mkdir "$work/tools" "$work/bin"
cp "$root/tools/install_packages" "$work/tools/"
cat >"$work/tools/packages.txt" <<'END'
# comment
[build]
compiler   # why
builder
[test]
oracle
END
cat >"$work/bin/dpkg-query" <<END
#!/bin/sh
while read -r name; do echo "\$name installed"; done <"$work/installed"
echo "removed config-files"
END
# Knows the packages in the file known; update makes it so.
cat >"$work/bin/apt-get" <<END
#!/bin/sh
echo "\$*" >>"$work/calls"
case "\$*" in
*update*) cp "$work/server" "$work/known"; exit 0 ;;
esac
for word in "\$@"; do
    case \$word in -*|install|DPkg*) continue ;; esac
    grep -qx "\$word" "$work/known" || { echo "E: Unable to locate package \$word" >&2; exit 100; }
done
case "\$*" in
*--assume-no*) echo "Need to get 5 MB of archives."; echo "After this operation, 20 MB of disk space will be used."; exit 1 ;;
esac
if [ -e "$work/stale" ]; then rm "$work/stale"; exit 100; fi
for word in "\$@"; do case \$word in -*|install|DPkg*) ;; *) echo "\$word" >>"$work/installed" ;; esac; done
END
printf '#!/bin/sh\necho "${user:-0}"\n' >"$work/bin/id"
printf '#!/bin/sh\necho "sudo $1" >>"%s/calls"\nexec "$@"\n' "$work" >"$work/bin/sudo"
chmod +x "$work"/bin/*
printf 'compiler\nbuilder\noracle\n' >"$work/server"

# state INSTALLED KNOWN: what is installed, and what apt-get has heard of.
state() {
    printf '%s' "$1" >"$work/installed"
    printf '%s' "$2" >"$work/known"
    rm -f "$work/calls" "$work/stale"
}
all='compiler
builder
oracle
'
install() { PATH="$work/bin:$PATH" "$work/tools/install_packages" "$@"; }
calls() { cat "$work/calls" 2>/dev/null || echo none; }

state "$all" "$all"
succeeds_with '^$' install build test
succeeds_with '^none$' calls

state 'compiler
' "$all"
succeeds_with 'Missing packages: builder$' install build
succeeds_with 'install builder$' calls
fails_with '' grep -q update "$work/calls"
succeeds_with '^builder$' cat "$work/installed"
succeeds_with '^$' install build

state '' "$all"
succeeds_with 'After this operation, 20 MB' install build test
succeeds_with '-y --no-install-recommends install compiler builder oracle' calls

# A fresh machine: no lists yet.
state '' ''
succeeds_with 'Fetching the lists' install build
succeeds_with 'update' calls

# Lists older than the server.
state '' "$all"
touch "$work/stale"
succeeds_with 'Packages installed' install build
succeeds_with 'update' calls

# Not even the server has it.
state '' ''
printf 'compiler\n' >"$work/server"
fails_with 'does not know all of: compiler builder' install build
printf 'compiler\nbuilder\noracle\n' >"$work/server"

# Not root: by sudo; without sudo it says what is missing and goes on.
state '' "$all"
export user=1000
succeeds_with 'takes sudo' install build
succeeds_with '^sudo env' calls
rm "$work/bin/sudo"
if ! command -v sudo >/dev/null; then
    state '' "$all"
    succeeds_with 'Going on with what is there' install build
    succeeds_with '^none$' calls
fi

fails_with 'no section \[nonsense\]' install nonsense

finish
