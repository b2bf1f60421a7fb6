/* @SUMMARY@
 *
 *   double @prefix@_eps_t(double @x@, double @y@)
 *       the coefficient of tangential restitution; NAN outside the table
 *   int @prefix@_region(double @x@, double @y@)
 *       @REGION@
 *   @NORMAL@
 *
@AXES@
 *
 * C99 and later, and C++; nothing but the standard library is needed. Results have the bits of
 * the program that wrote this file unless the compiler fuses products with sums; gcc and clang do
 * not with -ffp-contract=off. The bound holds in either case.
 */
#ifndef @PREFIX@_TABLE_H
#define @PREFIX@_TABLE_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define @PREFIX@_@X@_LOW @X_LOW@
#define @PREFIX@_@X@_HIGH @X_HIGH@
#define @PREFIX@_@Y@_LOW @Y_LOW@
#define @PREFIX@_@Y@_HIGH @Y_HIGH@
@CONSTANTS@#define @PREFIX@_BOUND @BOUND@

@ARRAYS@
/* A coordinate from 0 to 1, stretched: 0 not at all, 1 and 2 by the root of the distance from 0 and
 * from 1. */
static inline double @prefix@_stretched(unsigned stretch, double z)
{
    if (stretch == 0)
        return z;
    return stretch == 1 ? sqrt(z) : 1.0 - sqrt(1.0 - z);
}

/* The first bits of a number. */
static inline uint64_t @prefix@_bits(double value, unsigned shift)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits >> shift;
}

/* A polynomial with eight coefficients. */
static inline double @prefix@_value(const double *c, double along)
{
    double x = 2.0 * along - 1.0;
    double x2 = x * x;
    double low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
    double high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
    return low + high * (x2 * x2);
}

/* Whether the table has values at @x@; if so, the interval and the coordinate in it. */
static inline int @prefix@_slab(double @x@, uint32_t *slab, double *along)
{
    uint32_t at;
    double part;
    if (!(@x@ >= @PREFIX@_@X@_LOW && @x@ <= @PREFIX@_@X@_HIGH))
        return 0;
    at = @prefix@_slab_hints[@prefix@_bits(@x@, @SLAB_SHIFT@) - @SLAB_FIRST@];
    while (at + 1 < @SLABS@ && @prefix@_walls[at + 1] <= @x@)
        at++;
    part = (@x@ - @prefix@_walls[at]) * @prefix@_scales[at];
    *along = @prefix@_stretched(@prefix@_slab_stretches[at], part < 1.0 ? part : 1.0);
    *slab = at;
    return 1;
}

/* Whether the table has a value at @x@ and @y@; if so, the strip and the coordinates in it. */
static inline int @prefix@_place(double @x@, double @y@, uint32_t *strip, double *along,
                               double *across)
{
    uint32_t slab, at, end;
    double part, low, high;
    if (!(@y@ >= @PREFIX@_@Y@_LOW && @y@ <= @PREFIX@_@Y@_HIGH)
        || !@prefix@_slab(@x@, &slab, along))
        return 0;
    at = @prefix@_first_strips[slab]
        + @prefix@_strip_hints[slab][@prefix@_bits(@y@, @STRIP_SHIFT@) - @STRIP_FIRST@];
    end = @prefix@_first_strips[slab + 1];
    low = @prefix@_value(@prefix@_graphs[at], *along);
    high = @prefix@_value(@prefix@_graphs[at + 1], *along);
    while (at + 2 < end && high <= @y@) {
        at++;
        low = high;
        high = @prefix@_value(@prefix@_graphs[at + 1], *along);
    }
    part = (@y@ - low) / (high - low);
    part = part > 0.0 ? (part < 1.0 ? part : 1.0) : 0.0;
    *across = @prefix@_stretched(@prefix@_strip_stretches[at], part);
    *strip = at;
    return 1;
}

/* The sums over rows of twelve coefficients times powers of x. Two of them at once, where the compiler
 * can and @PREFIX@_ONE_BY_ONE is not defined, have the bits of one after the other. */
static inline void @prefix@_sums(const double (*rows)[12], uint32_t count, double x, double sums[12])
{
#if defined(__GNUC__) && !defined(@PREFIX@_ONE_BY_ONE)
    typedef double two __attribute__((vector_size(16)));
    two s0 = {0.0, 0.0}, s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, c[6];
    while (count-- > 0) {
        memcpy(c, rows[count], sizeof c);
        s0 = s0 * x + c[0];
        s1 = s1 * x + c[1];
        s2 = s2 * x + c[2];
        s3 = s3 * x + c[3];
        s4 = s4 * x + c[4];
        s5 = s5 * x + c[5];
    }
    memcpy(sums, &s0, sizeof s0);
    memcpy(sums + 2, &s1, sizeof s1);
    memcpy(sums + 4, &s2, sizeof s2);
    memcpy(sums + 6, &s3, sizeof s3);
    memcpy(sums + 8, &s4, sizeof s4);
    memcpy(sums + 10, &s5, sizeof s5);
#else
    int j;
    for (j = 0; j < 12; j++)
        sums[j] = 0.0;
    while (count-- > 0)
        for (j = 0; j < 12; j++)
            sums[j] = sums[j] * x + rows[count][j];
#endif
}

static inline double @prefix@_eps_t(double @x@, double @y@)
{
    double s[12], along, across, y, y2, y4;
    uint32_t strip, first;
    int j;
    if (!@prefix@_place(@x@, @y@, &strip, &along, &across))
        return NAN;
    first = @prefix@_first_rows[strip];
    @prefix@_sums(@prefix@_rows + first, @prefix@_first_rows[strip + 1] - first, 2.0 * along - 1.0, s);
    y = 2.0 * across - 1.0;
    y2 = y * y;
    y4 = y2 * y2;
    for (j = 0; j < 4; j++)
        s[j] = (s[j + 8] * y4 + s[j + 4]) * y4 + s[j];
    return (s[0] + s[2] * y2) + (s[1] + s[3] * y2) * y;
}
@FUNCTIONS@
#endif
