/* A calling program as MoorDyn's users write them. What it prints is compared with the command by compare.py; what it can judge alone, it does.

   drive abuse DECK FILE          wrong handles, pointers, numbers and orders of calls, each refused, and the mooring usable after each
   drive states DECK FILE         a state saved and restored, in memory and by a file, brings the same bits
   drive pendulum DECK            a mass that is let go swings as one should
   drive statics DECK             tensions, forces and nodes at rest
   drive run DECK STEP END PERIOD RAMP A1..A6
                                  everything coupled moves as one vessel about the origin: sines of surge .. yaw [m, deg], eased in */
#include "moordyn_subset.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST 64
static const double PI = 3.14159265358979323846;
static int failures = 0;

static void expect(const char *what, int found, int wanted)
{
    if (found != wanted) {
        fprintf(stderr, "FAILED %s: %d, not %d\n", what, found, wanted);
        failures++;
    }
}

#define EXPECT(call, wanted) expect(#call, call, wanted)
#define DO(call) expect(#call, call, MOORDYN_SUCCESS)

/* Positions of what is coupled where the file has it: bodies, rods, points. Returns the degrees of freedom. */
static unsigned first_positions(MoorDyn system, double *x, double *xd)
{
    unsigned n = 0, count, filled = 0, i;
    int type;
    DO(MoorDyn_NCoupledDOF(system, &n));
    memset(xd, 0, MOST * sizeof *xd);
    DO(MoorDyn_GetNumberBodies(system, &count));
    for (i = 1; i <= count; i++) {
        double rates[6];
        DO(MoorDyn_GetBodyType(MoorDyn_GetBody(system, i), &type));
        if (type == -1) {
            DO(MoorDyn_GetBodyState(MoorDyn_GetBody(system, i), x + filled, rates));
            filled += 6;
        }
    }
    DO(MoorDyn_GetNumberRods(system, &count));
    for (i = 1; i <= count; i++) {
        DO(MoorDyn_GetRodType(MoorDyn_GetRod(system, i), &type));
        if (type == -2) {
            DO(MoorDyn_GetRodNodePos(MoorDyn_GetRod(system, i), 0, x + filled));
            x[filled + 3] = x[filled + 4] = x[filled + 5] = 0.0;
            filled += 6;
        }
    }
    DO(MoorDyn_GetNumberPoints(system, &count));
    for (i = 1; i <= count; i++) {
        DO(MoorDyn_GetPointType(MoorDyn_GetPoint(system, i), &type));
        if (type == -1) {
            DO(MoorDyn_GetPointPos(MoorDyn_GetPoint(system, i), x + filled));
            filled += 3;
        }
    }
    expect("degrees of freedom filled", (int)filled, (int)n);
    return n;
}

static MoorDyn started(const char *deck, double *x, double *xd, unsigned *n)
{
    MoorDyn system = MoorDyn_Create(deck);
    if (!system) {
        fprintf(stderr, "FAILED: %s cannot be created\n", deck);
        exit(1);
    }
    *n = first_positions(system, x, xd);
    DO(MoorDyn_Init(system, x, xd));
    return system;
}

static void statics(const char *deck)
{
    double x[MOST], xd[MOST], f[MOST], t = 0.0, none = 0.0, v[3], ten;
    unsigned n, lines, points, i, node, nodes;
    MoorDyn system = started(deck, x, xd, &n);
    DO(MoorDyn_Step(system, x, xd, f, &t, &none));
    for (i = 0; i < n; i++)
        printf("f %u %.17g\n", i, f[i]);
    DO(MoorDyn_GetNumberLines(system, &lines));
    for (i = 1; i <= lines; i++) {
        MoorDynLine line = MoorDyn_GetLine(system, i);
        double length, most;
        int id;
        DO(MoorDyn_GetLineID(line, &id));
        DO(MoorDyn_GetLineFairTen(line, &ten));
        DO(MoorDyn_GetLineMaxTen(line, &most));
        DO(MoorDyn_GetLineUnstretchedLength(line, &length));
        DO(MoorDyn_GetLineNumberNodes(line, &nodes));
        printf("line %d %.17g %.17g %.17g %u\n", id, ten, most, length, nodes);
        for (node = 0; node < nodes; node++) {
            double r[3], q[3];
            DO(MoorDyn_GetLineNodePos(line, node, r));
            DO(MoorDyn_GetLineNodeTen(line, node, q));
            DO(MoorDyn_GetLineNodeVel(line, node, v));
            printf("node %d %u %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", id, node, r[0], r[1], r[2], q[0], q[1], q[2],
                   fabs(v[0]) + fabs(v[1]) + fabs(v[2]));
        }
    }
    DO(MoorDyn_GetNumberPoints(system, &points));
    for (i = 1; i <= points; i++) {
        double r[3];
        int id;
        DO(MoorDyn_GetPointID(MoorDyn_GetPoint(system, i), &id));
        DO(MoorDyn_GetPointPos(MoorDyn_GetPoint(system, i), r));
        DO(MoorDyn_GetPointForce(MoorDyn_GetPoint(system, i), v));
        printf("point %d %.17g %.17g %.17g %.17g %.17g %.17g\n", id, r[0], r[1], r[2], v[0], v[1], v[2]);
    }
    DO(MoorDyn_Close(system));
}

/* Roll, pitch and yaw, R = Rz Ry Rx, to the columns of R. */
static void turn_of(const double *q, double r[3][3])
{
    double cr = cos(q[0]), sr = sin(q[0]), cp = cos(q[1]), sp = sin(q[1]), cy = cos(q[2]), sy = sin(q[2]);
    double m[3][3] = {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
                      {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
                      {-sp, cp * sr, cp * cr}};
    memcpy(r, m, sizeof m);
}

/* The vessel at a time: position and roll, pitch, yaw. */
static void vessel_at(double t, double period, double ramp, const double *amplitudes, double *pose)
{
    double s = ramp > 0.0 && t < ramp ? t / ramp : 1.0, ease = s * s * (3.0 - 2.0 * s);
    int k;
    for (k = 0; k < 6; k++)
        pose[k] = amplitudes[k] * (k < 3 ? 1.0 : PI / 180.0) * sin(2.0 * PI / period * t) * ease;
}

/* Where what is coupled is at a time, from where it is at rest: six numbers in MoorDyn's angles, or three. */
static void moved(unsigned six, unsigned n, const double *at_rest, double t, double period, double ramp, const double *amplitudes, double *x)
{
    double pose[6], r[3][3];
    unsigned i, k, l;
    vessel_at(t, period, ramp, amplitudes, pose);
    turn_of(pose + 3, r);
    for (i = 0; i < n; i += i < six ? 6 : 3) {
        for (k = 0; k < 3; k++) {
            x[i + k] = pose[k];
            for (l = 0; l < 3; l++)
                x[i + k] += r[k][l] * at_rest[i + l];
        }
        if (i < six) {
            /* R = Rx Ry Rz of an attitude that is none at rest. */
            x[i + 3] = atan2(-r[1][2], r[2][2]);
            x[i + 4] = asin(r[0][2]);
            x[i + 5] = atan2(-r[0][1], r[0][0]);
        }
    }
}

/* Angular velocity of the vessel about global axes, by differences. */
static void turning(double t, double period, double ramp, const double *amplitudes, double *omega)
{
    const double h = 1e-5;
    double before[6], after[6], a[3][3], b[3][3], c[3][3];
    int i, j, k;
    vessel_at(t - h, period, ramp, amplitudes, before);
    vessel_at(t + h, period, ramp, amplitudes, after);
    turn_of(before + 3, b);
    turn_of(after + 3, a);
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            for (c[i][j] = 0.0, k = 0; k < 3; k++)
                c[i][j] += a[i][k] * b[j][k];
    omega[0] = (c[2][1] - c[1][2]) / (4.0 * h);
    omega[1] = (c[0][2] - c[2][0]) / (4.0 * h);
    omega[2] = (c[1][0] - c[0][1]) / (4.0 * h);
}

static void run(const char *deck, double step, double end, double period, double ramp, const double *amplitudes)
{
    double rest[MOST], x[MOST], xd[MOST], f[MOST], t = 0.0, ten;
    unsigned n, lines, points, i, six, count;
    int type;
    MoorDyn system = started(deck, rest, xd, &n);
    DO(MoorDyn_GetNumberLines(system, &lines));
    DO(MoorDyn_GetNumberPoints(system, &points));
    for (count = 0, i = 1; i <= points; i++) {
        DO(MoorDyn_GetPointType(MoorDyn_GetPoint(system, i), &type));
        count += type == -1;
    }
    six = n - 3 * count;
    while (t < end - 0.5 * step) {
        const double h = 1e-5;
        double before[MOST], after[MOST], now = t;
        moved(six, n, rest, t, period, ramp, amplitudes, x);
        moved(six, n, rest, t - h, period, ramp, amplitudes, before);
        moved(six, n, rest, t + h, period, ramp, amplitudes, after);
        for (i = 0; i < n; i++)
            xd[i] = (after[i] - before[i]) / (2.0 * h);
        for (i = 0; i < six; i += 6)
            turning(t, period, ramp, amplitudes, xd + i + 3);
        DO(MoorDyn_Step(system, x, xd, f, &t, &step));
        if (fabs(t - now - step) > 1e-9) {
            expect("the time goes on by the step", 0, 1);
            break;
        }
        printf("%.17g", t);
        for (i = 1; i <= lines; i++) {
            DO(MoorDyn_GetLineFairTen(MoorDyn_GetLine(system, i), &ten));
            printf(" %.17g", ten);
        }
        for (i = 0; i < n; i++)
            printf(" %.17g", f[i]);
        printf("\n");
    }
    DO(MoorDyn_Close(system));
}

/* Some steps with a motion of which every axis has its part; the forces of the last. */
static void some_steps(MoorDyn system, unsigned n, const double *rest, double from, int steps, double *f)
{
    double x[MOST], xd[MOST], t = from, dt = 0.1;
    int k;
    unsigned i;
    for (k = 0; k < steps; k++) {
        for (i = 0; i < n; i++) {
            x[i] = rest[i] + 0.02 * (1.0 + 0.1 * i) * sin(1.3 * (from + 0.1 * k));
            xd[i] = 0.026 * (1.0 + 0.1 * i) * cos(1.3 * (from + 0.1 * k));
        }
        DO(MoorDyn_Step(system, x, xd, f, &t, &dt));
    }
}

/* Without an equilibrium what is free begins where the file has it, and moves off; with one it begins elsewhere and stays. */
static void let_go(MoorDyn system, const double *rest, const double *xd)
{
    double at[MOST][3], r[3], f[MOST], t = 0.0, dt = 0.5;
    unsigned points, bodies, i, free_ones = 0;
    int type, settled;
    DO(MoorDyn_GetNumberPoints(system, &points));
    DO(MoorDyn_GetNumberBodies(system, &bodies));
    for (i = 0; i < points + bodies; i++)
        DO(i < points ? MoorDyn_GetPointPos(MoorDyn_GetPoint(system, i + 1), at[i])
                      : MoorDyn_GetBodyPos(MoorDyn_GetBody(system, i - points + 1), at[i]));
    for (settled = 0; settled < 2; settled++) {
        DO(settled ? MoorDyn_Init(system, rest, xd) : MoorDyn_Init_NoIC(system, rest, xd));
        for (i = 0; i < points + bodies; i++) {
            MoorDynPoint point = i < points ? MoorDyn_GetPoint(system, i + 1) : NULL;
            MoorDynBody body = i < points ? NULL : MoorDyn_GetBody(system, i - points + 1);
            double v[3];
            DO(point ? MoorDyn_GetPointType(point, &type) : MoorDyn_GetBodyType(body, &type));
            if (type != 0)
                continue;
            free_ones++;
            DO(point ? MoorDyn_GetPointPos(point, r) : MoorDyn_GetBodyPos(body, r));
            expect("begins where the file has it, or in equilibrium", memcmp(r, at[i], sizeof r) == 0, !settled);
            t = 0.0;
            DO(MoorDyn_Step(system, rest, xd, f, &t, &dt));
            DO(point ? MoorDyn_GetPointVel(point, v) : MoorDyn_GetBodyVel(body, v));
            expect("moves off, or stays", fabs(v[0]) + fabs(v[1]) + fabs(v[2]) < 1e-4, settled);
        }
    }
    expect("something is free", free_ones >= 2, 1);
    DO(MoorDyn_Init_NoIC(system, rest, xd));
}

/* A mass on a wire without drag: the period of a mathematical pendulum of its amplitude, T = 2 pi sqrt(l/g) (1 + a^2/16), and no loss. */
static void pendulum(const char *deck)
{
    const double length = 100.4988, angle = 0.0997, whole = 2.0 * PI * sqrt(length / 9.80665) * (1.0 + angle * angle / 16.0);
    double t = 0.0, dt = 0.05, before = 10.0, crossed = 0.0, r[3], swing = 0.0;
    int crossings = 0;
    MoorDyn system = MoorDyn_Create(deck);
    DO(MoorDyn_Init(system, NULL, NULL));
    while (crossings < 3 && t < 60.0) {
        DO(MoorDyn_Step(system, NULL, NULL, NULL, &t, &dt));
        DO(MoorDyn_GetPointPos(MoorDyn_GetPoint(system, 2), r));
        swing = fmax(swing, -r[0]);
        if (before * r[0] <= 0.0) {
            double now = t - dt * r[0] / (r[0] - before);
            double taken = now - crossed, wanted = crossings ? 0.5 * whole : 0.25 * whole;
            if (fabs(taken - wanted) > 2e-3 * whole) {
                fprintf(stderr, "the pendulum took %.4f s, not %.4f s\n", taken, wanted);
                expect("the period", 0, 1);
            }
            crossed = now;
            crossings++;
        }
        before = r[0];
    }
    expect("it swings", crossings, 3);
    expect("it swings as far as it came from", fabs(swing - 10.0) < 0.05, 1);
    DO(MoorDyn_Close(system));
}

static void states(const char *deck, const char *file)
{
    double rest[MOST], xd[MOST], f[MOST], g[MOST], h[MOST], r[3], s[3];
    unsigned n;
    size_t size = 0, again = 0;
    uint64_t *state;
    MoorDyn system = started(deck, rest, xd, &n), other;
    some_steps(system, n, rest, 0.0, 15, f);
    DO(MoorDyn_Serialize(system, &size, NULL));
    state = malloc(size + 16);
    memset(state, 0xAB, size + 16);
    DO(MoorDyn_Serialize(system, &again, state));
    expect("one size", size == again, 1);
    expect("nothing beyond it", ((unsigned char *)state)[size], 0xAB);
    DO(MoorDyn_Save(system, file));
    DO(MoorDyn_GetLineNodePos(MoorDyn_GetLine(system, 1), 3, r));
    some_steps(system, n, rest, 1.5, 12, f);
    DO(MoorDyn_Deserialize(system, state));
    DO(MoorDyn_GetLineNodePos(MoorDyn_GetLine(system, 1), 3, s));
    expect("the nodes are back", memcmp(r, s, sizeof r), 0);
    some_steps(system, n, rest, 1.5, 12, g);
    expect("from memory: the same bits", memcmp(f, g, n * sizeof *f), 0);
    other = MoorDyn_Create(deck);
    let_go(other, rest, xd);
    DO(MoorDyn_Load(other, file));
    some_steps(other, n, rest, 1.5, 12, h);
    expect("another mooring, from the file: the same bits", memcmp(f, h, n * sizeof *f), 0);
    /* What this can see at all: other motions bring other forces. */
    some_steps(other, n, rest, 2.7, 1, h);
    expect("other steps, other forces", memcmp(f, h, n * sizeof *f) != 0, 1);
    /* A damaged state is refused, and changes nothing. */
    state[size / 8 - 2] ^= 1;
    EXPECT(MoorDyn_Deserialize(system, state), MOORDYN_INVALID_INPUT);
    state[size / 8 - 2] ^= 1;
    state[0] ^= 1;
    EXPECT(MoorDyn_Deserialize(system, state), MOORDYN_INVALID_VALUE);
    state[0] ^= 1;
    DO(MoorDyn_Deserialize(system, state));
    some_steps(system, n, rest, 1.5, 12, g);
    expect("after damaged ones: the same bits", memcmp(f, g, n * sizeof *f), 0);
    free(state);
    DO(MoorDyn_Close(system));
    DO(MoorDyn_Close(other));
}

static void abuse(const char *deck, const char *file)
{
    double rest[MOST], x[MOST], xd[MOST], f[MOST], g[MOST], h[MOST], t = 0.0, dt = 0.1, none = 0.0, d, v[6];
    double not_a_number = NAN;
    float a[MOST], b[MOST], c[MOST], e[MOST];
    unsigned n, un;
    int k, id, many = 1000, all;
    uint64_t nonsense[4] = {1, 2, 3, 4};
    MoorDynLine line;
    MoorDyn system, closed;

    expect("a file that is not there", MoorDyn_Create("not there.txt") == NULL, 1);
    expect("a file that is none", MoorDyn_Create(file) == NULL, 1);
    EXPECT(MoorDyn_Init(NULL, x, xd), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_Init((MoorDyn)&t, x, xd), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_Step(NULL, x, xd, f, &t, &dt), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_Close(NULL), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_GetLineFairTen(NULL, &d), MOORDYN_INVALID_VALUE);

    /* The wrong order. */
    system = MoorDyn_Create(deck);
    n = first_positions(system, rest, xd);
    line = MoorDyn_GetLine(system, 1);
    EXPECT(MoorDyn_Step(system, rest, xd, f, &t, &dt), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_GetLineFairTen(line, &d), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_GetLineNodePos(line, 0, v), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_Serialize(system, NULL, NULL), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_Save(system, file), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDyn_Init(system, NULL, xd), MOORDYN_INVALID_VALUE);
    memcpy(x, rest, sizeof x);
    x[1] = not_a_number;
    EXPECT(MoorDyn_Init(system, x, xd), MOORDYN_NAN_ERROR);
    /* Out of reach: the lines would break; the file's place then does. */
    memcpy(x, rest, sizeof x);
    x[0] += 1.0e7;
    expect("out of reach is no equilibrium", MoorDyn_Init(system, x, xd) != MOORDYN_SUCCESS, 1);
    EXPECT(MoorDyn_Step(system, rest, xd, f, &t, &dt), MOORDYN_INVALID_VALUE);
    DO(MoorDyn_Init(system, rest, xd));

    /* Each of these is refused and changes nothing: the forces after all of them are those of a mooring that never saw them. */
    for (k = 0; k < 2; k++) {
        t = 0.0;
        DO(MoorDyn_Step(system, rest, xd, h, &t, &dt));
        if (k == 0) {
            const double infinite = INFINITY, negative = -1.0, eternal = 1.0e9;
            double step = infinite;
            size_t size;
            EXPECT(MoorDyn_Step(system, NULL, xd, f, &t, &dt), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Step(system, rest, NULL, f, &t, &dt), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Step(system, rest, xd, NULL, &t, &dt), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Step(system, rest, xd, f, NULL, &dt), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Step(system, rest, xd, f, &t, NULL), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Step(system, rest, xd, f, &t, &step), MOORDYN_NAN_ERROR);
            step = not_a_number;
            EXPECT(MoorDyn_Step(system, rest, xd, f, &t, &step), MOORDYN_NAN_ERROR);
            step = eternal;
            EXPECT(MoorDyn_Step(system, rest, xd, f, &t, &step), MOORDYN_INVALID_VALUE);
            step = negative;
            DO(MoorDyn_Step(system, rest, xd, g, &t, &step));
            expect("no step: the same forces", memcmp(h, g, n * sizeof *f), 0);
            DO(MoorDyn_Step(system, NULL, NULL, g, &t, &none));
            expect("no step: the same forces", memcmp(h, g, n * sizeof *f), 0);
            memcpy(x, rest, sizeof x);
            x[n - 1] = not_a_number;
            EXPECT(MoorDyn_Step(system, x, xd, f, &t, &dt), MOORDYN_NAN_ERROR);
            x[n - 1] = rest[n - 1] - 500.0;
            EXPECT(MoorDyn_Step(system, x, xd, f, &t, &dt), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Deserialize(system, NULL), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Deserialize(system, nonsense), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Load(system, "not there"), MOORDYN_INVALID_INPUT_FILE);
            EXPECT(MoorDyn_Load(system, deck), MOORDYN_INVALID_INPUT);
            EXPECT(MoorDyn_Load(system, NULL), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Save(system, "not there/state"), MOORDYN_INVALID_OUTPUT_FILE);
            EXPECT(MoorDyn_SetLogFile(system, "not there/log"), MOORDYN_INVALID_OUTPUT_FILE);
            EXPECT(MoorDyn_GetLineNodePos(line, 100000, v), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_GetLineNodePos(line, 0, NULL), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_GetLineID((MoorDynLine)MoorDyn_GetPoint(system, 1), &id), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_GetPointAttached(MoorDyn_GetPoint(system, 1), 99, &line, &id), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_GetFASTtens(system, &many, a, b, c, e), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_GetFASTtens(system, NULL, a, b, c, e), MOORDYN_INVALID_VALUE);
            expect("no line 0", MoorDyn_GetLine(system, 0) == NULL, 1);
            expect("no point 1000", MoorDyn_GetPoint(system, 1000) == NULL, 1);
            EXPECT(MoorDyn_SetDt(system, 1e-3), MOORDYN_NON_IMPLEMENTED);
            EXPECT(MoorDyn_SetTimeScheme(system, "RK4"), MOORDYN_NON_IMPLEMENTED);
            EXPECT(MoorDyn_GetTimeScheme(system, NULL, &size), MOORDYN_NON_IMPLEMENTED);
            EXPECT(MoorDyn_SetLineUnstretchedLength(line, 10.0), MOORDYN_NON_IMPLEMENTED);
            EXPECT(MoorDyn_SaveVTK(system, "x.vtm"), MOORDYN_NON_IMPLEMENTED);
            EXPECT(MoorDyn_GetLineNodeDrag(line, 0, v), MOORDYN_NON_IMPLEMENTED);
        }
        DO(MoorDyn_Step(system, rest, xd, k == 0 ? f : g, &t, &dt));
        if (k == 0) {
            DO(MoorDyn_Close(system));
            closed = system;
            EXPECT(MoorDyn_Close(closed), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_Step(closed, rest, xd, x, &t, &dt), MOORDYN_INVALID_VALUE);
            EXPECT(MoorDyn_GetLineFairTen(line, &d), MOORDYN_INVALID_VALUE);
            system = started(deck, rest, xd, &n);
            line = MoorDyn_GetLine(system, 1);
            expect("no handle is given twice", system != closed, 1);
        }
    }
    expect("what was refused left no trace", memcmp(f, g, n * sizeof *f), 0);

    /* What the waves and the bed say. */
    DO(MoorDyn_ExternalWaveKinInit(system, &un));
    expect("no place waits for waves", (int)un, 0);
    DO(MoorDyn_GetWavesKin(MoorDyn_GetWaves(system), 0.0, 0.0, -5.0, v, v + 3, &d, &t, NULL));
    expect("a level bed is no object", MoorDyn_GetSeafloor(system) == NULL, 1);
    expect("deep water", fabs(WaveNumber(2.0, 10.0, 1e4) - 0.4) < 1e-9, 1);
    expect("no wave", WaveNumber(0.0, 0.0, 0.0) == 0.0, 1);
    DO(MoorDyn_GetNumberLines(system, &un));
    all = (int)un;
    DO(MoorDyn_GetFASTtens(system, &all, a, b, c, e));
    for (k = 0; k < all; k++) {
        DO(MoorDyn_GetLineFairTen(MoorDyn_GetLine(system, k + 1), &d));
        expect("FASTtens make the tension", fabs(hypot(a[k], b[k]) - d) < 1e-6 * d, 1);
        DO(MoorDyn_GetLineNodeWeight(MoorDyn_GetLine(system, k + 1), 2, v));
        if (v[2] < 0.0)
            expect("a heavy line pulls its fairlead down", b[k] < 0.0, 1);
    }
    DO(MoorDyn_Close(system));

    /* Version 1. */
    EXPECT(MoorDynStep(rest, xd, f, &t, &dt), MOORDYN_INVALID_VALUE);
    EXPECT(MoorDynClose(), MOORDYN_INVALID_VALUE);
    EXPECT(GetNodePos(1, 0, v), MOORDYN_MEM_ERROR);
    EXPECT(MoorDynInit(rest, xd, "not there.txt"), MOORDYN_UNHANDLED_ERROR);
    DO(MoorDynInit(rest, xd, deck));
    t = 0.0;
    DO(MoorDynStep(rest, xd, f, &t, &dt));
    DO(MoorDynStep(rest, xd, f, &t, &dt));
    expect("version 1 has the same forces", memcmp(f, g, n * sizeof *f), 0);
    DO(GetNodePos(1, 0, v));
    expect("a tension", GetFairTen(1) > 0.0, 1);
    DO(MoorDynClose());
    EXPECT(MoorDynClose(), MOORDYN_INVALID_VALUE);
}

int main(int count, char **words)
{
    const char *kind = count > 2 ? words[1] : "";
    if (!strcmp(kind, "abuse") && count == 4)
        abuse(words[2], words[3]);
    else if (!strcmp(kind, "states") && count == 4)
        states(words[2], words[3]);
    else if (!strcmp(kind, "pendulum") && count == 3)
        pendulum(words[2]);
    else if (!strcmp(kind, "statics") && count == 3)
        statics(words[2]);
    else if (!strcmp(kind, "run") && count == 13) {
        double amplitudes[6];
        int k;
        for (k = 0; k < 6; k++)
            amplitudes[k] = atof(words[7 + k]);
        run(words[2], atof(words[3]), atof(words[4]), atof(words[5]), atof(words[6]), amplitudes);
    } else {
        fprintf(stderr, "see the head of drive.c\n");
        return 2;
    }
    return failures ? 1 : 0;
}
