/* What a careful C programmer writes for one problem: three modes, n = 4, m = 2, doubles in arrays of fixed size, no allocation, every
 * bound a constant. Symmetric matrices are stored full and computed by their lower triangle. */
#include <math.h>

#define N 4
#define M 2
#define MODES 3
#define MOST_POINTS 33

typedef struct { double x[N], p[N][N]; } gaussian;
typedef struct {
    double f[MODES][N][N], q[N][N], h[M][N], r[M][M], chain[MODES][MODES];
    int points; /* 0: the Kalman filter */
    double point[MOST_POINTS][N], weight[MOST_POINTS], covariance_weight[MOST_POINTS];
} model;
typedef struct { gaussian mode[MODES], combined, prediction; double probability[MODES]; } filter;

static void merge(const double *weight, const gaussian *component, gaussian *out) {
    double deviation[MODES][N];
    for (int a = 0; a < N; a++) {
        out->x[a] = 0;
        for (int i = 0; i < MODES; i++) out->x[a] += weight[i] * component[i].x[a];
    }
    for (int i = 0; i < MODES; i++)
        for (int a = 0; a < N; a++) deviation[i][a] = component[i].x[a] - out->x[a];
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++) {
            double sum = 0;
            for (int i = 0; i < MODES; i++) sum += weight[i] * (component[i].p[a][b] + deviation[i][a] * deviation[i][b]);
            out->p[a][b] = sum;
        }
}

static void mirror(double p[N][N]) {
    for (int a = 0; a < N; a++)
        for (int b = a + 1; b < N; b++) p[a][b] = p[b][a];
}

/* The square root of a covariance times each point of the rule, about the mean. */
static void draw(const model *k, const gaussian *g, double out[MOST_POINTS][N]) {
    double root[N][N] = {{0}};
    for (int j = 0; j < N; j++) {
        double pivot = g->p[j][j];
        for (int l = 0; l < j; l++) pivot -= root[j][l] * root[j][l];
        root[j][j] = sqrt(pivot);
        for (int i = j + 1; i < N; i++) {
            double entry = g->p[i][j];
            for (int l = 0; l < j; l++) entry -= root[i][l] * root[j][l];
            root[i][j] = entry / root[j][j];
        }
    }
    for (int s = 0; s < k->points; s++)
        for (int a = 0; a < N; a++) {
            double sum = g->x[a];
            for (int b = 0; b <= a; b++) sum += root[a][b] * k->point[s][b];
            out[s][a] = sum;
        }
}

static void predict_linear(const model *k, int j, const gaussian *mixed, gaussian *g) {
    double fp[N][N];
    for (int a = 0; a < N; a++) {
        g->x[a] = 0;
        for (int b = 0; b < N; b++) g->x[a] += k->f[j][a][b] * mixed->x[b];
    }
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++) {
            fp[a][b] = 0;
            for (int e = 0; e < N; e++) fp[a][b] += k->f[j][a][e] * mixed->p[e][b];
        }
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++) {
            double sum = k->q[a][b];
            for (int e = 0; e < N; e++) sum += fp[a][e] * k->f[j][b][e];
            g->p[a][b] = sum;
        }
    mirror(g->p);
}

static void predict_points(const model *k, int j, const gaussian *mixed, gaussian *g) {
    double point[MOST_POINTS][N], moved[MOST_POINTS][N];
    draw(k, mixed, point);
    for (int a = 0; a < N; a++) g->x[a] = 0;
    for (int s = 0; s < k->points; s++)
        for (int a = 0; a < N; a++) {
            double sum = 0;
            for (int b = 0; b < N; b++) sum += k->f[j][a][b] * point[s][b];
            moved[s][a] = sum;
            g->x[a] += k->weight[s] * sum;
        }
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++) g->p[a][b] = k->q[a][b];
    for (int s = 0; s < k->points; s++) {
        double deviation[N];
        for (int a = 0; a < N; a++) deviation[a] = moved[s][a] - g->x[a];
        for (int a = 0; a < N; a++)
            for (int b = 0; b < N; b++) g->p[a][b] += k->covariance_weight[s] * deviation[a] * deviation[b];
    }
}

static double wrap(double angle) {
    const double pi = 3.141592653589793;
    return angle > pi ? angle - 2 * pi : angle <= -pi ? angle + 2 * pi : angle;
}

static void see_linear(const model *k, const gaussian *g, const double z[M], double nu[M], double s[M][M], double c[N][M]) {
    for (int a = 0; a < N; a++)
        for (int o = 0; o < M; o++) {
            c[a][o] = 0;
            for (int e = 0; e < N; e++) c[a][o] += g->p[a][e] * k->h[o][e];
        }
    for (int a = 0; a < M; a++) {
        nu[a] = z[a];
        for (int e = 0; e < N; e++) nu[a] -= k->h[a][e] * g->x[e];
        for (int o = 0; o < M; o++) {
            s[a][o] = k->r[a][o];
            for (int e = 0; e < N; e++) s[a][o] += k->h[a][e] * c[e][o];
        }
    }
}

static void see_points(const model *k, const gaussian *g, const double z[M], double nu[M], double s[M][M], double c[N][M]) {
    double point[MOST_POINTS][N], seen[MOST_POINTS][M], mean[M] = {0}, centre = atan2(g->x[2], g->x[0]);
    draw(k, g, point);
    for (int p = 0; p < k->points; p++) {
        seen[p][0] = sqrt(point[p][0] * point[p][0] + point[p][2] * point[p][2]);
        seen[p][1] = atan2(point[p][2], point[p][0]);
        mean[0] += k->weight[p] * seen[p][0];
        mean[1] += k->weight[p] * wrap(seen[p][1] - centre);
    }
    mean[1] += centre;
    for (int a = 0; a < M; a++)
        for (int o = 0; o < M; o++) s[a][o] = k->r[a][o];
    for (int a = 0; a < N; a++)
        for (int o = 0; o < M; o++) c[a][o] = 0;
    for (int p = 0; p < k->points; p++) {
        double d[M] = {seen[p][0] - mean[0], wrap(seen[p][1] - mean[1])};
        for (int a = 0; a < M; a++)
            for (int o = 0; o < M; o++) s[a][o] += k->covariance_weight[p] * d[a] * d[o];
        for (int a = 0; a < N; a++)
            for (int o = 0; o < M; o++) c[a][o] += k->covariance_weight[p] * (point[p][a] - g->x[a]) * d[o];
    }
    nu[0] = z[0] - mean[0];
    nu[1] = wrap(z[1] - mean[1]);
}

/* Gain by S = L D L', update, log-likelihood. */
static double correct(gaussian *g, const double nu[M], const double s[M][M], const double c[N][M]) {
    double lower = s[1][0] / s[0][0], first = s[0][0], second = s[1][1] - lower * lower * first, gain[N][M];
    for (int a = 0; a < N; a++) {
        gain[a][1] = (c[a][1] - lower * c[a][0]) / second;
        gain[a][0] = c[a][0] / first - lower * gain[a][1];
        g->x[a] += gain[a][0] * nu[0] + gain[a][1] * nu[1];
    }
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++) g->p[a][b] -= gain[a][0] * c[b][0] + gain[a][1] * c[b][1];
    mirror(g->p);
    double rest = nu[1] - lower * nu[0];
    return -0.5 * (nu[0] * nu[0] / first + rest * rest / second + log(39.478417604357434 * first * second));
}

void imm_step(const model *k, filter *t, const double z[M]) {
    double c[MODES], mixing[MODES], log_likelihood[MODES], sum = 0;
    gaussian g[MODES], mixed;
    for (int j = 0; j < MODES; j++) {
        c[j] = 0;
        for (int i = 0; i < MODES; i++) c[j] += k->chain[i][j] * t->probability[i];
        for (int i = 0; i < MODES; i++) mixing[i] = k->chain[i][j] * t->probability[i] / c[j];
        merge(mixing, t->mode, &mixed);
        (k->points ? predict_points : predict_linear)(k, j, &mixed, &g[j]);
    }
    merge(c, g, &t->prediction);
    for (int j = 0; j < MODES; j++) {
        double nu[M], s[M][M], cross[N][M];
        (k->points ? see_points : see_linear)(k, &g[j], z, nu, s, cross);
        t->mode[j] = g[j];
        log_likelihood[j] = correct(&t->mode[j], nu, s, cross);
    }
    double greatest = log_likelihood[0];
    for (int j = 1; j < MODES; j++) greatest = log_likelihood[j] > greatest ? log_likelihood[j] : greatest;
    for (int j = 0; j < MODES; j++) sum += t->probability[j] = exp(log_likelihood[j] - greatest) * c[j];
    for (int j = 0; j < MODES; j++) t->probability[j] /= sum;
    merge(t->probability, t->mode, &t->combined);
}
