% Files of GNU Octave: octave --no-gui --norc make.m, started in this folder.
k = (0:399)';
t = k * 0.001;
u = 1.5 * sin(2 * pi * 5 * t);
y = 2 * u + 0.25 * u .^ 2;
fs = 1000;
save -v7 octave-v7.mat t u y fs
save -v6 octave-v6.mat t u y
save -hdf5 octave.h5 t u y fs
runs = struct('u', {u, 0.5 * u}, 'y', {y, 0.5 * y});
save -v7 octave-runs.mat runs fs
data = [t u y];
save -v7 octave-matrix.mat data
file = fopen('octave.csv', 'w');
fprintf(file, '# written by GNU Octave\n');
fprintf(file, 'time_s,current_A,displacement_um\n');
fprintf(file, '%.17g,%.17g,%.17g\n', [t u y]');
fclose(file);
dlmwrite('octave-bare.txt', [t u y], 'delimiter', ' ', 'precision', '%.17g');
