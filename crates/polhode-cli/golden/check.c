/* Largest angle between the attitudes of RUN.csv and GOLDEN.csv: cc check.c -o check -lm && ./check GOLDEN.csv RUN.csv [TOLERANCE] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The next row of t,q_w,q_x,q_y,q_z,...; comments and the header are skipped. */
static int next(FILE *file, double r[5]) {
    char line[4096];
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf", r, r + 1, r + 2, r + 3, r + 4) == 5) return 1;
    return 0;
}

int main(int argc, char **argv) {
    FILE *golden = argc > 2 ? fopen(argv[1], "r") : NULL, *run = argc > 2 ? fopen(argv[2], "r") : NULL;
    double g[5], r[5], before = 0, near = 0, worst = 0, limit = argc > 3 ? atof(argv[3]) : 1e-6;
    int rows = 0, found = 0, more = run && next(run, r);
    while (golden && more && next(golden, g)) {
        near = rows++ ? 1e-6 * (g[0] - before) : 0, before = g[0];
        while (more && r[0] < g[0] - near) more = next(run, r);
        if (!more || r[0] > g[0] + near) continue;
        double *a = g + 1, *b = r + 1, w = a[0]*b[0] + a[1]*b[1] + a[2]*b[2] + a[3]*b[3];
        double x = a[0]*b[1] - b[0]*a[1] - a[2]*b[3] + a[3]*b[2], y = a[0]*b[2] - b[0]*a[2] - a[3]*b[1] + a[1]*b[3];
        double z = a[0]*b[3] - b[0]*a[3] - a[1]*b[2] + a[2]*b[1], angle = 2 * atan2(sqrt(x*x + y*y + z*z), fabs(w));
        if (!(angle <= worst)) worst = angle;
        found++;
    }
    printf("%d rows compared, largest angle %.3e rad, allowed %.1e\n", found, worst, limit);
    return found > 1 && found == rows && !(golden && next(golden, g)) && worst <= limit ? 0 : 1;
}
