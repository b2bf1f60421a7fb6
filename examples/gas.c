/* A gas of rough spheres that collide at moments, not in time steps.
 *
 *   stickslip table --bodies examples/gas_spheres.json --normal 1e-3:10 --tangential 1e-3:20 \
 *     --bound 1e-6 --prefix gas --out gas_table.h
 *   cc -O2 -I. examples/gas.c -o gas -lm
 *   ./gas 4000 60 table > table.csv
 *   ./gas 4000 60 0.21 > constant.csv
 *
 * The arguments are the number of spheres, the number of collisions a sphere, and what the
 * coefficient of tangential restitution is: that of the table, or one number. The normal one is
 * always that of the table. Lines of the output are about the state after each collision a sphere:
 *
 *   collisions     collisions a sphere, each of which counts for both spheres
 *   time_s         time
 *   translational  mean energy of the motion of centres, as a part of that at the start
 *   rotational     mean energy of spins, in the same unit
 *   mean_eps_t     mean of eps_t in the collisions since the last line; empty in the first one
 *
 * Spheres fly straight between collisions in a periodic box, which is divided into cells. Each
 * sphere has one event, its next collision or its next way into another cell, and a heap finds the
 * first of all (Rapaport, The Art of Molecular Dynamics Simulation, chapter 14). */

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gas_table.h"

#define RADIUS 1e-3      /* m, of the spheres of the table */
#define ALPHA (2.0 / 7.0) /* homogeneous spheres */
#define FRACTION 0.05    /* of the volume in spheres */
#define CROSSING (-1)

typedef struct {
    double x[3], v[3], w[3]; /* at `time`: centre, velocity, spin times radius */
    double time;
    int cell[3], next, previous; /* neighbours in the list of the cell */
    double event;                /* time of the next event */
    int partner;                 /* who collides, or CROSSING along `axis` */
    int axis;
    int place; /* in the heap */
} Sphere;

static Sphere *spheres;
static int count, cells, *heads, *heap;
static double box, side, now;
static double use_eps_t; /* NAN: that of the table */
static double sum_eps_t;
static long collisions, outside;

/* Numbers from 0 to 1 (SplitMix64). */
static double uniform(void)
{
    static uint64_t state = 1;
    uint64_t z = state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double normal(void)
{
    double radius = sqrt(-2.0 * log(1.0 - uniform()));
    return radius * cos(6.283185307179586 * uniform());
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The heap of events. */

static int earlier(int a, int b)
{
    return spheres[a].event < spheres[b].event;
}

static void put(int place, int sphere)
{
    heap[place] = sphere;
    spheres[sphere].place = place;
}

static void sift(int sphere)
{
    int place = spheres[sphere].place, other;
    while (place > 0 && earlier(sphere, heap[other = (place - 1) / 2])) {
        put(place, heap[other]);
        place = other;
    }
    while ((other = 2 * place + 1) < count) {
        if (other + 1 < count && earlier(heap[other + 1], heap[other]))
            other++;
        if (!earlier(heap[other], sphere))
            break;
        put(place, heap[other]);
        place = other;
    }
    put(place, sphere);
}

/* Cells. */

static int *head(const int *cell)
{
    return &heads[(cell[0] * cells + cell[1]) * cells + cell[2]];
}

static void enter(int i)
{
    int *first = head(spheres[i].cell);
    spheres[i].previous = -1;
    spheres[i].next = *first;
    if (*first >= 0)
        spheres[*first].previous = i;
    *first = i;
}

static void leave(int i)
{
    Sphere *s = &spheres[i];
    if (s->previous >= 0)
        spheres[s->previous].next = s->next;
    else
        *head(s->cell) = s->next;
    if (s->next >= 0)
        spheres[s->next].previous = s->previous;
}

/* Motion. */

static void advance(Sphere *s)
{
    int k;
    for (k = 0; k < 3; k++)
        s->x[k] += s->v[k] * (now - s->time);
    s->time = now;
}

/* The way from the centre of b to that of a at the present time, across the edge if that is
 * shorter. */
static void between(const Sphere *a, const Sphere *b, double *way)
{
    int k;
    for (k = 0; k < 3; k++) {
        way[k] = a->x[k] + a->v[k] * (now - a->time) - b->x[k] - b->v[k] * (now - b->time);
        way[k] -= box * round(way[k] / box);
    }
}

/* When two spheres touch, if they do. */
static double touch(const Sphere *a, const Sphere *b)
{
    double way[3], v[3], rate, speed, gap, root;
    int k;
    between(a, b, way);
    for (k = 0; k < 3; k++)
        v[k] = a->v[k] - b->v[k];
    rate = dot(way, v);
    if (rate >= 0.0)
        return INFINITY;
    speed = dot(v, v);
    gap = dot(way, way) - 4.0 * RADIUS * RADIUS;
    root = rate * rate - speed * gap;
    if (root < 0.0)
        return INFINITY;
    return now + fmax(gap, 0.0) / (sqrt(root) - rate);
}

/* When a sphere leaves its cell, if it does not touch another one before. */
static void leave_next(Sphere *s)
{
    int k;
    s->event = INFINITY;
    s->partner = CROSSING;
    for (k = 0; k < 3; k++) {
        double edge = side * (s->v[k] > 0.0 ? s->cell[k] + 1 : s->cell[k]);
        double when = s->v[k] != 0.0 ? s->time + (edge - s->x[k]) / s->v[k] : INFINITY;
        if (when < s->event) {
            s->event = fmax(when, now);
            s->axis = k;
        }
    }
}

/* Finds the next event of a sphere. Of a pair, both have the event. */
static void predict(int i)
{
    Sphere *s = &spheres[i];
    int cell[3], a, b, c, j;
    leave_next(s);
    for (a = -1; a <= 1; a++)
        for (b = -1; b <= 1; b++)
            for (c = -1; c <= 1; c++) {
                cell[0] = (s->cell[0] + a + cells) % cells;
                cell[1] = (s->cell[1] + b + cells) % cells;
                cell[2] = (s->cell[2] + c + cells) % cells;
                for (j = *head(cell); j >= 0; j = spheres[j].next) {
                    double when = j == i ? INFINITY : touch(s, &spheres[j]);
                    if (when < s->event && when <= spheres[j].event) {
                        s->event = when;
                        s->partner = j;
                    }
                }
            }
    if (s->partner >= 0) {
        Sphere *other = &spheres[s->partner];
        int third = other->partner;
        other->event = s->event;
        other->partner = i;
        sift(s->partner);
        if (third >= 0 && third != i) {
            /* The third sphere has lost its partner. Until it is looked at again, nothing happens
             * to it but that. */
            spheres[third].partner = CROSSING;
            spheres[third].axis = -1;
            spheres[third].event = now;
            sift(third);
        }
    }
    sift(i);
}

static void cross(int i)
{
    Sphere *s = &spheres[i];
    int k = s->axis, up = s->v[k] > 0.0;
    leave(i);
    s->cell[k] += up ? 1 : -1;
    /* On the edge itself, free of rounding. */
    s->x[k] = side * (up ? s->cell[k] : s->cell[k] + 1);
    if (s->cell[k] == cells || s->cell[k] < 0) {
        s->x[k] = up ? 0.0 : box;
        s->cell[k] = up ? 0 : cells - 1;
    }
    enter(i);
}

static double within(double value, double low, double high)
{
    return fmin(fmax(value, low), high);
}

/* Two spheres touch. The velocity of their surfaces against each other has the part g_n along the
 * line of centres and g_t across; after the collision they are -eps_n g_n and eps_t g_t. */
static void collide(int i, int j)
{
    Sphere *a = &spheres[i], *b = &spheres[j];
    double n[3], g[3], impulse[3], across, g_n, g_t, eps_n, eps_t, inside_n, inside_t;
    int k;
    between(a, b, n);
    across = sqrt(dot(n, n));
    for (k = 0; k < 3; k++)
        n[k] /= across;
    for (k = 0; k < 3; k++) {
        int l = (k + 1) % 3, m = (k + 2) % 3;
        double spin = (a->w[l] + b->w[l]) * n[m] - (a->w[m] + b->w[m]) * n[l];
        g[k] = a->v[k] - b->v[k] - spin;
    }
    g_n = -dot(g, n);
    for (k = 0; k < 3; k++)
        g[k] += g_n * n[k];
    g_t = sqrt(dot(g, g));
    /* What is beyond the table takes the nearest value that it has. */
    inside_n = within(g_n, GAS_G_N_LOW, GAS_G_N_HIGH);
    inside_t = within(g_t, GAS_G_T_LOW, GAS_G_T_HIGH);
    outside += inside_n != g_n || inside_t != g_t;
    eps_n = gas_eps_n(inside_n);
    eps_t = isnan(use_eps_t) ? gas_eps_t(inside_n, inside_t) : use_eps_t;
    for (k = 0; k < 3; k++)
        impulse[k] = 0.5 * ((1.0 + eps_n) * g_n * n[k] - ALPHA * (1.0 - eps_t) * g[k]);
    for (k = 0; k < 3; k++) {
        int l = (k + 1) % 3, m = (k + 2) % 3;
        /* Mass and radius are 1 here, and the moment of inertia is ALPHA/(1 - ALPHA). */
        double turn = (n[l] * impulse[m] - n[m] * impulse[l]) * (1.0 - ALPHA) / ALPHA;
        a->v[k] += impulse[k];
        b->v[k] -= impulse[k];
        a->w[k] -= turn;
        b->w[k] -= turn;
    }
    collisions++;
    sum_eps_t += eps_t;
}

/* Mean energies of a sphere: of its motion, and of its spin. */
static void energies(double *motion, double *spin)
{
    int i;
    *motion = *spin = 0.0;
    for (i = 0; i < count; i++) {
        *motion += 0.5 * dot(spheres[i].v, spheres[i].v) / count;
        *spin += 0.5 * ALPHA / (1.0 - ALPHA) * dot(spheres[i].w, spheres[i].w) / count;
    }
}

/* Spheres on a lattice with velocities of Maxwell's distribution, of 1 m/s in each direction, and
 * no spins. No sphere moves the centre of all. */
static void start(void)
{
    int i, k, edge = (int)ceil(cbrt(count));
    double mean[3] = {0.0, 0.0, 0.0};
    box = cbrt(count * 4.0 / 3.0 * 3.141592653589793 / FRACTION) * RADIUS;
    cells = (int)(box / (2.0 * RADIUS));
    if (cells > edge)
        cells = edge;
    side = box / cells;
    for (i = 0; i < cells * cells * cells; i++)
        heads[i] = -1;
    for (i = 0; i < count; i++)
        for (k = 0; k < 3; k++) {
            spheres[i].v[k] = normal();
            mean[k] += spheres[i].v[k] / count;
        }
    for (i = 0; i < count; i++) {
        Sphere *s = &spheres[i];
        int place[3];
        place[0] = i / (edge * edge);
        place[1] = i / edge % edge;
        place[2] = i % edge;
        for (k = 0; k < 3; k++) {
            s->x[k] = box * (place[k] + 0.5) / edge;
            s->v[k] -= mean[k];
            s->w[k] = 0.0;
            s->cell[k] = (int)(s->x[k] / side);
        }
        enter(i);
        s->event = INFINITY;
        put(i, i);
    }
    for (i = 0; i < count; i++) {
        leave_next(&spheres[i]);
        sift(i);
    }
    for (i = 0; i < count; i++)
        if (spheres[i].partner == CROSSING)
            predict(i);
}

int main(int argc, char **argv)
{
    int lines, line = 0, edge;
    double first, motion, spin;
    count = argc == 4 ? atoi(argv[1]) : 0;
    lines = argc == 4 ? atoi(argv[2]) : 0;
    use_eps_t = argc == 4 && strcmp(argv[3], "table") != 0 ? atof(argv[3]) : NAN;
    if (count < 64 || count > 1000000 || lines < 1 || fabs(use_eps_t) > 1.0) {
        fprintf(stderr, "usage: gas SPHERES COLLISIONS table|EPS_T\n"
                        "expected 64 to 1000000 spheres, 1 collision or more, and EPS_T from -1 to 1\n");
        return 2;
    }
    edge = (int)ceil(cbrt(count));
    spheres = calloc((size_t)count, sizeof *spheres);
    heap = calloc((size_t)count, sizeof *heap);
    heads = calloc((size_t)edge * edge * edge, sizeof *heads);
    if (!spheres || !heap || !heads) {
        fprintf(stderr, "no memory for %d spheres\n", count);
        return 1;
    }
    start();
    energies(&first, &spin);
    printf("collisions,time_s,translational,rotational,mean_eps_t\n0,0,1,0,\n");
    while (line < lines) {
        int i = heap[0], j = spheres[i].partner;
        now = spheres[i].event;
        if (j == CROSSING) {
            if (spheres[i].axis >= 0) {
                advance(&spheres[i]);
                cross(i);
            }
        } else {
            advance(&spheres[i]);
            advance(&spheres[j]);
            collide(i, j);
            spheres[j].event = INFINITY;
            spheres[j].partner = CROSSING;
            sift(j);
        }
        predict(i);
        if (j != CROSSING && spheres[j].partner == CROSSING)
            predict(j);
        if (j != CROSSING && 2 * collisions >= (long)count * (line + 1)) {
            line++;
            energies(&motion, &spin);
            printf("%d,%.9e,%.9e,%.9e,%.6f\n", line, now, motion / first, spin / first,
                   2.0 * sum_eps_t / count);
            sum_eps_t = 0.0;
        }
    }
    fprintf(stderr, "%ld collisions, of which %ld were beyond the table\n", collisions, outside);
    free(spheres);
    free(heap);
    free(heads);
    return 0;
}
