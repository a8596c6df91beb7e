# Completion of burr for bash. burr itself says what may come next: `burr __complete WORDS`.
_burr() {
  local cur words cword line suffix said=() IFS=$'\n'
  _get_comp_words_by_ref -n := cur words cword
  COMPREPLY=()
  mapfile -t said < <("${words[0]}" __complete "${words[@]:1:cword}" 2>/dev/null)
  for line in "${said[@]}"; do
    case $line in
      :files) compopt -o filenames; COMPREPLY+=($(compgen -f -- "$cur")) ;;
      :files\ *)
        compopt -o filenames
        COMPREPLY+=($(compgen -d -- "$cur"))
        IFS=' '
        for suffix in ${line#:files }; do
          IFS=$'\n'
          COMPREPLY+=($(compgen -f -X "!*.$suffix" -- "$cur"))
        done
        IFS=$'\n'
        ;;
      *) COMPREPLY+=("${line%%$'\t'*}") ;;
    esac
  done
  # bash replaces only what stands after its last word break
  if [[ $cur == *=* && $COMP_WORDBREAKS == *=* ]]; then
    local before=${cur%"${cur##*=}"}
    COMPREPLY=("${COMPREPLY[@]#"$before"}")
  fi
  __ltrim_colon_completions "$cur"
}
complete -F _burr burr
