# Error and time of meshes over their spacing. From the folder of the CSV:
#   gnuplot mesh.gnuplot    -> mesh.svg
set terminal svg size 900,420 font "sans,13" background rgb "white"
set output "mesh.svg"
set datafile separator ","
set multiplot layout 1,2
set logscale xy
set grid
set xlabel "spacing [Å]"
set xrange [2.2:0.11]
set xtics (2, 1, 0.5, 0.25, 0.125)
file = "mesh.csv"
row(scene) = sprintf("< grep '^%s,' %s", scene, file)
set key bottom left
set ylabel "99 % of the distances are wrong by at most [Å]"
plot for [s in "ubiquitin hemoglobin C60 packed"] row(s eq "packed" ? "packed balls" : s) using 3:14 with linespoints title s eq "packed" ? "100,000 packed balls" : s
set key bottom right samplen 2
set yrange [0.1:20000]
set ylabel "making the mesh, ms of processor time"
plot for [s in "ubiquitin hemoglobin C60 packed"] row(s eq "packed" ? "packed balls" : s) using 3:7 with linespoints title s eq "packed" ? "100,000 packed balls" : s
unset multiplot
