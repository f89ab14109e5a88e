_BIN_complete() {
    local IFS=$' \t\n' line=${COMP_LINE:0:COMP_POINT} rest word text reply at
    local -a words=() replies=()
    rest=$line
    for ((at = 0; at <= COMP_CWORD; at++)); do
        word=${COMP_WORDS[at]}
        text=${rest#"${rest%%[![:space:]]*}"}
        # The last word goes to the cursor.
        ((at < COMP_CWORD)) || word=$text
        if ((at > 0)) && [[ $text == "$rest" && -n $text ]]; then
            words[${#words[@]} - 1]+=$word
        else
            words+=("$word")
        fi
        rest=${text#"$word"}
    done
    word=${words[${#words[@]} - 1]}
    # Readline replaces no more than its own last part.
    local kept=${word%"$2"}
    [[ -n $2 || $word == *[=:] ]] || kept=
    IFS=$'\v'
    replies=($(_CLAP_IFS=$'\v' _CLAP_COMPLETE_INDEX=$((${#words[@]} - 1)) VAR=bash COMPLETER -- "${words[@]}" 2>/dev/null)) || return
    IFS=$' \t\n'
    COMPREPLY=()
    for reply in "${replies[@]}"; do
        reply=${reply#"$kept"}
        case $reply in
            *[[:space:]\'\"\\\$\&\;\|\<\>\(\)\*\?\[\`\!]*) printf -v reply %q "$reply" ;;
        esac
        COMPREPLY+=("$reply")
    done
    # What ends so goes on.
    if ((${#COMPREPLY[@]} == 1)) && [[ ${COMPREPLY[0]} == *[=/:,] ]]; then
        compopt -o nospace 2>/dev/null
    fi
}
complete -o bashdefault -F _BIN_complete BIN
