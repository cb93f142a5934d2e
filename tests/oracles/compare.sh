# For the scripts beside it. same_stress IMPORT_OUTPUT "xx A yy B ...": the sums of pairs that
# "grainfield import" printed against the other program's, within 1e-10 of the largest.
same_stress() {
  awk -v theirs="$2" '
    /pairs:/ { sub(/.*pairs: */, ""); n = split($0, a, " "); for (i = 1; i < n; i += 2) ours[a[i]] = a[i + 1] }
    END {
      n = split(theirs, b, " "); top = 0; worst = 0
      for (i = 2; i <= n; i += 2) { v = b[i] < 0 ? -b[i] : b[i] + 0; if (v > top) top = v }
      for (i = 1; i < n; i += 2) {
        d = ours[b[i]] - b[i + 1]; if (d < 0) d = -d; if (d > worst) worst = d
        printf "%s  grainfield %.15g  theirs %.15g\n", b[i], ours[b[i]], b[i + 1]
      }
      printf "largest difference / largest component: %.2g\n", worst / top
      exit !(top > 0 && worst <= 1e-10 * top)
    }' "$1"
}
