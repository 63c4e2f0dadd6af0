# Sourced by npm-packages and python-packages: a folder of pinned packages outside the tree, made once and shared by clones and builds.

fail() {
  echo "third_party/${0##*/}: $*" >&2
  exit 1
}

# pinned_folder NAME WHAT HOW FLAG: prints ${XDG_CACHE_HOME:-~/.cache}/NAME. Where it isn't there yet, the caller's `obtain FOLDER` fills a
# folder beside it, which takes the name when it is whole. FLAG --cached: never obtains. WHAT: the packages in words; HOW: what obtains them.
pinned_folder() {
  local folder=${XDG_CACHE_HOME:-$HOME/.cache}/$1 what=$2 how=$3 flag=$4
  if [ ! -d "$folder" ]; then
    [ "$flag" != --cached ] || fail "the $what aren't there yet: run $how"
    mkdir -p "${folder%/*}"
    making=$(mktemp -d "${folder%/*}/making-XXXXXX")
    trap 'rm -rf "$making"' EXIT
    obtain "$making/set" >&2 || fail "could not obtain the $what. It needs the network once; afterwards $folder is enough."
    mv -T "$making/set" "$folder" 2>/dev/null || [ -d "$folder" ] || fail "could not write $folder" # another run may have been faster
  fi
  echo "$folder"
}
