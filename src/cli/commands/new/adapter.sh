#!/bin/sh
# Runs @NAME@ on one case of a study.
#
#     adapter.sh CASE.json OUT
#
# CASE.json describes the problem (`oedometer schema case` has every key; SI units), OUT is an empty folder for the
# result. The small solver below, in awk, works: replace it with yours.
#
# Exit code 0: solved. 77: it cannot run here, the case is skipped. Any other: it failed, and the last lines on
# standard error are kept.
set -eu
command -v awk >/dev/null || { echo "there is no awk" >&2; exit 77; }

awk '
    { text = text $0 " " }
    function behind(key) {                       # what stands behind the first key of a name
        if (!match(text, "\"" key "\": *")) { print "the case has no " key > "/dev/stderr"; failed = 1; exit 2 }
        return substr(text, RSTART + RLENGTH)
    }
    function number(key) { return behind(key) + 0 }
    END {
        if (failed) exit 2
        cells = number("cells"); height = number("height"); load = number("load")
        modulus = number("oedometric_modulus"); weight = number("unit_weight_of_water")
        storage = number("porosity") / number("water_bulk_modulus")
        diffusivity = number("hydraulic_conductivity") / weight / (1 / modulus + storage)
        list = behind("times"); sub(/\].*/, "", list); sub(/\[/, "", list)
        outputs = split(list, times, ",")
        suggested = number("time_step"); spacing = height / cells; time = 0
        for (i = 0; i < cells; i++) p[i] = load / (1 + modulus * storage)   # the undrained start
        p[cells] = 0                                                        # the drained surface
        print "t,y,p,u_y"
        for (output = 1; output <= outputs; output++) {
            end = times[output] + 0
            steps = int((end - time) / suggested - 1e-9) + 1
            ratio = diffusivity * (end - time) / steps / spacing ^ 2
            for (s = 0; s < steps; s++) {                                   # backward Euler by the algorithm of Thomas
                for (i = 0; i < cells; i++) {
                    pivot = 1 + 2 * ratio + (i ? ratio * upper[i - 1] : 0)
                    upper[i] = (i ? -ratio : -2 * ratio) / pivot
                    right[i] = (p[i] + (i ? ratio * right[i - 1] : 0)) / pivot
                }
                for (i = cells - 1; i >= 0; i--) p[i] = right[i] - upper[i] * p[i + 1]
            }
            time = end; u = 0
            for (i = 0; i <= cells; i++) {
                if (i) u -= spacing * (load - 0.5 * (p[i] + p[i - 1])) / modulus
                printf "%.17g,%.17g,%.17g,%.17g\n", time, i * spacing, p[i], u
            }
        }
    }
' "$1" > "$2/result.csv"
