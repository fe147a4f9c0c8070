# Error against time of soft shadows, and of supersampling. From the folder of the CSV:
#   gnuplot shadow_error.gnuplot    -> shadow_error.svg
set terminal svg size 900,420 font "sans,13" background rgb "white"
set output "shadow_error.svg"
set datafile separator ","
set multiplot layout 1,2
set logscale xy
set grid
set ylabel "RMS error (0..1)"
set key bottom left samplen 2
set yrange [0.0003:1]
set title "Soft shadows, 2 Å penumbra, against 4,096 samples"
set xlabel "shadow pass, ms of processor time"
file = "shadow_error.csv"
row(scene, pattern) = sprintf("< grep '^shadow,\"%s\",2,' %s | grep '%s'", scene, file, pattern)
plot row("ubiquitin, space-filling", ",[0-9]*,[0-9]*,0") using 8:6 with linespoints lc 1 title "ubiquitin, spheres", \
     row("ubiquitin, space-filling", " to ") using 8:6 with points pt 4 ps 1.5 lc 1 notitle, \
     row("hemoglobin, licorice", ",[0-9]*,[0-9]*,0") using 8:6 with linespoints lc 2 title "hemoglobin, licorice", \
     row("hemoglobin, licorice", " to ") using 8:6 with points pt 4 ps 1.5 lc 2 title "adaptive: 8 to 64, 16 to 64", \
     row("ACE2 x 8, space-filling", ",[0-9]*,[0-9]*,0") using 8:6 with linespoints lc 3 title "ACE2 x 8, spheres"
set autoscale y
set title "Supersampling against 256 rays"
set xlabel "frame, ms of processor time"
plot "< grep '^supersampling' shadow_error.csv" using 9:6 with linespoints lc 4 title "ubiquitin: 1, 4, 16 rays"
unset multiplot
