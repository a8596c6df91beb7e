# Completion of burr for fish. burr itself says what may come next: `burr __complete WORDS`.
function __burr_complete
    set -l words (commandline -opc)
    set -l now (commandline -ct)
    for line in ($words[1] __complete $words[2..-1] "$now" 2>/dev/null)
        if test "$line" = ":files"
            __fish_complete_path "$now"
        else if string match -q ":files *" -- $line
            for suffix in (string split " " -- (string replace ":files " "" -- $line))
                __fish_complete_suffix .$suffix
            end
        else
            echo $line
        end
    end
end
complete -c burr -f -a '(__burr_complete)'
