#compdef BIN
_BIN_complete() {
    local -a replies folders open whole
    local reply value
    replies=("${(@f)$(_CLAP_IFS=$'\n' _CLAP_COMPLETE_INDEX=$((CURRENT - 1)) VAR=zsh COMPLETER -- "${words[@]:0:$CURRENT}" 2>/dev/null)}")
    for reply in $replies; do
        # Its own colons are escaped, the one before the explanation is not.
        value=${reply%%[^\\]:*}
        [[ $value == $reply ]] || value=$value${${reply#$value}[1]}
        case $value in
            */) folders+=("${value%/}${reply#$value}") ;;
            *[=,]) open+=("$reply") ;;
            *) whole+=("$reply") ;;
        esac
    done
    [[ -z $folders ]] || _describe -V values folders -S / -r /
    [[ -z $open ]] || _describe -V values open -S ''
    [[ -z $whole ]] || _describe -V values whole
}
if [[ ${funcstack[1]} == _BIN ]]; then
    _BIN_complete "$@"
else
    compdef _BIN_complete BIN
fi
