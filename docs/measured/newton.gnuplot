# Where the poster's iteration fails, and how wrong the ambient field is. From the folder of the CSV:
#   gnuplot newton.gnuplot    -> newton.svg
set terminal svg size 900,420 font "sans,13" background rgb "white"
set output "newton.svg"
set datafile separator ","
set multiplot layout 1,2
set logscale xy
set grid
set key top right samplen 2
set yrange [0.008:1]
set title "The poster's iteration, 1UBQ: wrong pixels"
set xlabel "iterations at most"
set ylabel "share of the pixels that the truth hits"
set xrange [1:64]
file = "newton.csv"
plain(terms) = sprintf("< grep '^plain,ubiquitin,[0-9]*,%d,' %s", terms, file)
plot for [k in "1 2 4 8"] plain(k + 0) using 3:(($10 + $11 + $12) / $7) with linespoints title sprintf("%s exact, ambient field", k), \
     plain(0) using 3:(($10 + $11 + $12) / $7) with linespoints lw 2 title "all terms"
set key bottom left samplen 2
set yrange [0.0001:1]
set title "Ambient field, 1UBQ: error on the surface"
set xlabel "cells along the longest side"
set ylabel "RMS error of the field, share of the level"
set xrange [16:256]
ambient(terms) = sprintf("< grep '^ambient,ubiquitin,0,%d,' %s", terms, file)
plot for [k in "1 2 4 8"] ambient(k + 0) using ($5 > 0 ? $5 : NaN):17 with linespoints title sprintf("%s exact", k)
unset multiplot
