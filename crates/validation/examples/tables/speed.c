/* Times the look-up of the table at the points of a file. */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "table.h"

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(void)
{
    enum { MOST = 1000000 };
    double(*points)[2] = malloc(MOST * sizeof *points);
    FILE *file = fopen("points", "rb");
    double best = INFINITY, sum = 0.0;
    size_t count, k;
    int round;
    if (!points || !file)
        return 1;
    count = fread(points, sizeof *points, MOST, file);
    for (round = 0; round < 5; round++) {
        double start = seconds(), time;
        for (k = 0; k < count; k++)
            sum += stickslip_eps_t(points[k][0], points[k][1]);
        time = (seconds() - start) / (double)count;
        if (time < best)
            best = time;
    }
    printf("table in C    %6.1f ns (mean %g)\n", 1e9 * best, sum / 5.0 / (double)count);
    return 0;
}
