#!/usr/bin/env bash
# Checks what shells offer on a command line of burr: bash always, fish and zsh where they are installed.
#
#     scripts/checks/completion.sh BUILD
#
# With BURR_REQUIRE_TOOLS=1 a missing shell is a failure.
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
completion=$PWD/packaging/completion
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir "$place/bin" "$place/here" "$place/here/folder"
ln -s "$build/burr" "$place/bin/burr"
export PATH=$place/bin:$PATH
cd "$place/here"
touch a.mcap b.mcap c.txt d.toml
bad=0
wants() { # what, wanted, got: words in any order
  local wanted got
  wanted=$(tr ' ' '\n' <<<"$2" | sort | xargs)
  got=$(tr ' ' '\n' <<<"$3" | sort | xargs)
  [ "$wanted" = "$got" ] || { echo "$1: offers \"$got\", not \"$wanted\""; bad=1; }
}
offers() { burr __complete "$@" | cut -f1 | xargs; }

# ---- burr itself
wants "a command" "replay repair report" "$(offers re)"
wants "a command below a command" "xapi" "$(offers learner xa)"
wants "an option" "--second-tool" "$(offers mill --second-to)"
wants "a value of a set" "bone" "$(offers export s.mcap --part bo)"
wants "a value of a set, with =" "--part=removed" "$(offers export s.mcap --part=re)"
wants "a tool" "sagittal-saw" "$(offers mill x --tool sag)"
wants "a tool, after other options with values" "sagittal-saw" "$(offers mill x --at 1 2 3 --burr-mm 4 --tool sag)"
wants "a phantom" "phantom:temporal-bone phantom:tooth :files" "$(offers mill phantom:t)"
wants "a case" "tooth :files toml" "$(offers case check too)"
wants "a recording" ":files mcap" "$(offers replay "")"
wants "a device" "haply" "$(offers devices test ha)"
wants "a command to help with" "surgeon" "$(offers help su)"
wants "a number" "" "$(offers mill x --burr-mm "")"
wants "nothing that there is" "" "$(offers no-such-command)"

# every command and every option of each help is offered, and no other
look() {
  local help options sub both
  help=$(burr "$@" --help)
  options=$(sed -n '/^Options:/,/^$/s/^  \(-[a-z],\)\?\(--[a-z0-9-]*\).*/\2/p' <<<"$help" | xargs)
  # newer CLI11 (Debian 13) refuses one name for both, when the program starts
  both=$(sed -n '/^Positionals:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/--\1/p' <<<"$help" | grep -xFf <(tr ' ' '\n' <<<"$options") || true)
  wants "positionals of burr $* that are named as an option is" "" "$both"
  wants "options of burr $*" "$options" "$(offers "$@" --)"
  local below
  mapfile -t below < <(sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/\1/p' <<<"$help")
  for sub in "${below[@]}"; do
    wants "burr $* $sub" "$sub" "$(offers "$@" "$sub" | tr ' ' '\n' | grep -x -- "$sub")"
    look "$@" "$sub"
  done
}
look

# ---- bash, with the functions of bash-completion that Debian's file of completions may use
if [ -f /usr/share/bash-completion/bash_completion ]; then
  in_bash() { # the line, then its words as bash breaks them
    bash -c 'source /usr/share/bash-completion/bash_completion; source "$0"; compopt() { :; }
      COMP_LINE=$1; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_POINT=${#COMP_LINE}; _burr; echo "${COMPREPLY[*]}"' \
      "$completion/burr.bash" "$@"
  }
  wants "bash: a command" "replay repair report" "$(in_bash "burr re" burr re)"
  wants "bash: recordings and folders" "a.mcap b.mcap folder" "$(in_bash "burr replay " burr replay "")"
  wants "bash: after a colon" "temporal-bone tooth" "$(in_bash "burr mill phantom:t" burr mill phantom : t)"
  wants "bash: after =" "removed" "$(in_bash "burr export s --part=re" burr export s --part = re)"
  echo "bash: looked at"
elif [ "${BURR_REQUIRE_TOOLS:-0}" = 1 ]; then
  echo "bash-completion is not installed"; bad=1
fi
# ---- fish
if command -v fish >/dev/null; then
  in_fish() { HOME=$place XDG_CONFIG_HOME=$place/config fish -c "source '$completion/burr.fish'; complete -C '$1'" | cut -f1 | xargs; }
  wants "fish: a command" "replay repair report" "$(in_fish "burr re")"
  wants "fish: a tool" "sagittal-saw" "$(in_fish "burr mill x --tool sag")"
  wants "fish: a recording" "a.mcap" "$(in_fish "burr replay a")"
  echo "fish: looked at"
elif [ "${BURR_REQUIRE_TOOLS:-0}" = 1 ]; then
  echo "fish is not installed"; bad=1
fi
# ---- zsh completes only at a terminal: it gets a pseudo terminal, and its line is read back
if command -v zsh >/dev/null; then
  cat >"$place/try.zsh" <<'Z'
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "fpath=($1 \$fpath); autoload -U compinit; compinit -D -u; compdef _burr burr; bindkey '^I' complete-word; setopt no_beep; PROMPT='>'; print READY-NOW"
zpty -r -m shell line '*READY-NOW*READY-NOW*'
zpty -w -n shell "burr mill x --tool sag"$'\t'
zpty -r -m shell line '*sagittal-saw*' && print sagittal-saw
zpty -w -n shell $'\x15'"burr repl"$'\t'
zpty -r -m shell line '*replay*' && print replay
zpty -d shell
Z
  wants "zsh: a tool and a command" "replay sagittal-saw" "$(timeout 60 zsh -f "$place/try.zsh" "$completion" | xargs)"
  echo "zsh: looked at"
elif [ "${BURR_REQUIRE_TOOLS:-0}" = 1 ]; then
  echo "zsh is not installed"; bad=1
fi
exit $bad
