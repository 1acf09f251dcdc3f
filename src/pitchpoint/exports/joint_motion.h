/* Rotor and load of a drive with its friction, wind-up, play, hysteresis and error over the angle between them.
 *
 * Everything counts at the output. Of the angles a of the driver over the ratio and b of the load,
 *     J1 a'' = motor - friction - T (1 - e'(a)),    J2 b'' = T - load,
 *     T = curve(d) + held(d) z + damping d',    d = a - b - e(a),
 * with the error e by which the output lags. Teeth that the wind-up slides hold as much as their loop is high: z
 * goes with d from -1 to 1 within JOINT_LOOP_TRAVEL, and fades while the driver slides the teeth itself, for
 * what they hold then is in the map. Without a curve the drive is rigid, b = a - e(a), and T follows from
 * both inertias. Friction is the torque that the loss map loses under T, times its waves over the angle of the
 * driver; at rest it is what holds. A rigid drive that a heavy load is to turn against friction that locks has no
 * such T: it jams, and stands at once. */
#ifndef JOINT_MOTION_H
#define JOINT_MOTION_H

enum {
    MOTOR_TORQUE,
    LOAD_TORQUE,
    TEMPERATURE,
    INERTIA,
    LOAD_INERTIA,
    DAMPING,
    RIPPLE,
    START_ANGLE,
    START_SPEED,
    START_WIND_UP,
    START_WIND_UP_RATE,
    SETTABLE,
    ANGLE = SETTABLE,
    SPEED,
    OUTPUT_ANGLE,
    OUTPUT_SPEED,
    WIND_UP,
    TORQUE,
    FRICTION,
    LOSS,
    REALS
};
enum { STICKS = REALS, OUTSIDE, ALL };

#define CREEPS 8       /* turns of the sense of motion in a step, behind which friction holds to its end */
#define HALVINGS 50    /* of the part of a step after which the driver rests; most steps to a torque */
#define UNBOUNDED 1e30 /* torque beyond which none is looked for */
#define PARTS 100.0    /* steps in the shortest period of the wind-up */
#define WAVE_PARTS 30.0 /* steps in the shortest wave of the error */
#define LONGEST_STEP 1e-4
#define MOST_STEPS 1e9
#define JOINT_LAST (JOINT_KNOTS > 1 ? JOINT_KNOTS - 1 : 1) /* number of the last point */

static const double joint_turn = 6.283185307179586;

struct motion {
    double angle, speed, output, output_speed;
    double wind_up, slid; /* where the wind-up was, and z there */
    int jams; /* no torque goes on with this motion, whose numbers are none then */
};

struct joint {
    double inputs[SETTABLE];
    double time;
    int started;
    struct motion now;
};

/* Forces on a state; friction is that along the motion, against which way it is counted by the sense. */
struct forces {
    double wind_up, rate, slope, bend, waves, torque, friction, acceleration, load_acceleration;
    int jams;
};

static double joint_error(double angle, double *slope, double *bend)
{
    double error = *slope = *bend = 0.0;
    for (int k = 0; k < JOINT_WAVES; ++k) {
        const double order = joint_wave_order[k], phase = order * angle + joint_wave_phase[k];
        error += joint_wave_amplitude[k] * cos(phase);
        *slope -= joint_wave_amplitude[k] * order * sin(phase);
        *bend -= joint_wave_amplitude[k] * order * order * cos(phase);
    }
    return error;
}

/* Friction over its mean at an angle of the driver. */
static double joint_waves(const struct joint *joint, double angle)
{
    double waves = 0.0;
    for (int k = 0; k < JOINT_FRICTION_WAVES; ++k)
        waves += joint_friction_amplitude[k] * cos(joint_friction_order[k] * angle + joint_friction_phase[k]);
    return fmax(1.0 + joint->inputs[RIPPLE] * waves, 0.0);
}

/* What part of the friction of the wound up teeth acts at a wind-up, -1 to 1. */
static double joint_slid(const struct motion *from, double wind_up)
{
    if (!(JOINT_LOOP_TRAVEL > 0.0))
        return 0.0;
    return fmax(-1.0, fmin(1.0, from->slid + (wind_up - from->wind_up) / JOINT_LOOP_TRAVEL));
}

/* Torque that friction of the wound up teeth holds, linear between the points. */
static double joint_held(double wind_up)
{
    const double way = fabs(wind_up) - 0.5 * JOINT_PLAY;
    const double *at = joint_wind_up, *height = joint_loop_torque;
    int k = 0;
    if (way <= 0.0)
        return height[0];
    if (way >= at[JOINT_LAST])
        return height[JOINT_LAST];
    while (way >= at[k + 1])
        ++k;
    return height[k] + (way - at[k]) * (height[k + 1] - height[k]) / (at[k + 1] - at[k]);
}

/* Torque of the wind-up: cubics through points with their slopes behind half the play, straight beyond. */
static double joint_spring(double wind_up)
{
    const double way = fabs(wind_up) - 0.5 * JOINT_PLAY;
    const double *at = joint_wind_up, *height = joint_wind_up_torque, *slope = joint_stiffness;
    int k = 0;
    if (JOINT_KNOTS < 2 || way <= 0.0)
        return 0.0;
    while (k < JOINT_KNOTS - 2 && way >= at[k + 1])
        ++k;
    const double last = at[JOINT_LAST], past = way > last ? way - last : 0.0;
    const double step = at[k + 1] - at[k], mean = (height[k + 1] - height[k]) / step, x = way - past - at[k];
    const double curve = (3.0 * mean - 2.0 * slope[k] - slope[k + 1]) / step;
    const double change = (slope[k] + slope[k + 1] - 2.0 * mean) / (step * step);
    const double torque = height[k] + x * (slope[k] + x * (curve + x * change)) + slope[JOINT_LAST] * past;
    return wind_up < 0.0 ? -torque : torque;
}

/* Torque that is lost along a motion of one sense; where friction locks, what holds more than the load. */
static double joint_lost(const struct joint *joint, double torque, double speed, double sense, double waves)
{
    const double degree = joint->inputs[TEMPERATURE];
    const double lost = loss_table_lost(sense * torque, fabs(speed), degree, JOINT_LAW);
    if (!(lost < 0.0))
        return lost * waves;
    const double alone = loss_table_lost(0.0, fabs(speed), degree, JOINT_LAW);
    return JOINT_LOCKED_SHARE * fabs(torque) + (alone > 0.0 ? alone : 0.0);
}

/* In motion that which is slowest or faster, for at rest the table has what starts the drive. */
static double joint_sliding(const struct joint *joint, double torque, double speed, double sense, double waves)
{
    const double least = 1e-3 * loss_table_speeds[1];
    return joint_lost(joint, torque, fabs(speed) > least ? speed : least, sense, waves);
}

/* An inertia; that which is not known and was not set is small until the start, which it forbids. */
static double joint_inertia(const struct joint *joint, int which)
{
    return fmax(joint->inputs[which], 1e-12);
}

static double joint_motor(const struct joint *joint)
{
    return joint->inputs[MOTOR_TORQUE] / LOSS_TABLE_SPEED_RATIO;
}

/* How much more torque a rigid drive has than its load and the motion of both ask for. */
static double joint_excess(const struct joint *joint, const struct forces *at, double speed, double sense,
                           double torque)
{
    const double inertia = joint_inertia(joint, LOAD_INERTIA), gain = 1.0 - at->slope;
    double acceleration = 0.0;
    if (sense != 0.0)
        acceleration = (joint_motor(joint) - sense * joint_sliding(joint, torque, speed, sense, at->waves) -
                        torque * gain) /
                       joint_inertia(joint, INERTIA);
    return torque - joint->inputs[LOAD_TORQUE] - inertia * (gain * acceleration - at->bend * speed * speed);
}

/* Torque of a rigid drive on its load, by the rule of false position that halves what stays (Illinois).
 * Where friction locks, the excess of torques that push along the motion falls while they grow: none of them brakes
 * a heavy load, and the drive jams. No number where there is no torque. */
static double joint_rigid(const struct joint *joint, const struct forces *at, double speed, double sense, int *jams)
{
    double low = joint->inputs[LOAD_TORQUE] - 1.0, high = low + 2.0, middle = low;
    double below = joint_excess(joint, at, speed, sense, low), above = joint_excess(joint, at, speed, sense, high);
    if (below > 0.0 || above < 0.0) {
        const double free = joint_excess(joint, at, speed, sense, 0.0);
        if (low < 0.0 && free <= 0.0)
            low = 0.0, below = free;
        if (high > 0.0 && free >= 0.0)
            high = 0.0, above = free;
    }
    const double first = below, last = above;
    for (double more = 2.0; below > 0.0 && more < UNBOUNDED; more *= 4.0)
        below = joint_excess(joint, at, speed, sense, low -= more);
    for (double more = 2.0; above < 0.0 && more < UNBOUNDED; more *= 4.0)
        above = joint_excess(joint, at, speed, sense, high += more);
    *jams = (below > 0.0 && below > first) || (above < 0.0 && above < last);
    if (!(below <= 0.0 && above >= 0.0))
        return NAN;
    for (int k = 0, stays = 0; k < HALVINGS && below < 0.0 && above > 0.0; ++k) {
        middle = high - above * ((high - low) / (above - below));
        const double there = joint_excess(joint, at, speed, sense, middle);
        if (fabs(there) <= 1e-12 * (1.0 + fabs(middle)))
            return middle;
        if (there > 0.0) {
            high = middle, above = there;
            below *= stays > 0 ? 0.5 : 1.0;
            stays = 1;
        } else {
            low = middle, below = there;
            above *= stays < 0 ? 0.5 : 1.0;
            stays = -1;
        }
    }
    return below == 0.0 ? low : above == 0.0 ? high : middle;
}

/* Sense is that of the motion of the driver, 0 where it rests. */
static struct forces joint_forces(const struct joint *joint, const struct motion *at, double sense)
{
    struct forces found;
    found.waves = joint_waves(joint, at->angle);
    const double error = joint_error(at->angle, &found.slope, &found.bend);
    found.wind_up = JOINT_KNOTS ? at->angle - at->output - error : 0.0;
    found.rate = JOINT_KNOTS ? at->speed * (1.0 - found.slope) - at->output_speed : 0.0;
    found.jams = 0;
    found.torque = JOINT_KNOTS ? joint_spring(found.wind_up) + joint->inputs[DAMPING] * found.rate +
                                     joint_held(found.wind_up) * joint_slid(at, found.wind_up)
                               : joint_rigid(joint, &found, at->speed, sense, &found.jams);
    found.friction = sense == 0.0 ? joint_motor(joint) - found.torque * (1.0 - found.slope)
                                  : sense * joint_sliding(joint, found.torque, at->speed, sense, found.waves);
    found.acceleration = (joint_motor(joint) - found.friction - found.torque * (1.0 - found.slope)) /
                         joint_inertia(joint, INERTIA);
    if (sense == 0.0)
        found.acceleration = 0.0;
    found.load_acceleration = JOINT_KNOTS ? (found.torque - joint->inputs[LOAD_TORQUE]) / joint_inertia(joint, LOAD_INERTIA)
                                          : (1.0 - found.slope) * found.acceleration -
                                                found.bend * at->speed * at->speed;
    return found;
}

/* Sense in which the torques move a driver at rest; 0 where friction holds it. */
static double joint_breaks(const struct joint *joint, const struct motion *at)
{
    const struct forces here = joint_forces(joint, at, 0.0);
    const double sense = here.friction < 0.0 ? -1.0 : 1.0;
    return fabs(here.friction) > joint_lost(joint, here.torque, 0.0, sense, here.waves) ? sense : 0.0;
}

static struct motion joint_moved(const struct motion *from, const struct motion *at, const struct forces *by,
                                 double step)
{
    struct motion to = *from;
    to.angle += step * at->speed;
    to.speed += step * by->acceleration;
    to.output += step * at->output_speed;
    to.output_speed += step * by->load_acceleration;
    return to;
}

/* Step of Runge and Kutta with friction of one sense. */
static struct motion joint_advanced(const struct joint *joint, double step, double sense)
{
    const struct motion *from = &joint->now;
    const struct forces first = joint_forces(joint, from, sense);
    const struct motion middle = joint_moved(from, from, &first, 0.5 * step);
    const struct forces second = joint_forces(joint, &middle, sense);
    const struct motion again = joint_moved(from, &middle, &second, 0.5 * step);
    const struct forces third = joint_forces(joint, &again, sense);
    const struct motion end = joint_moved(from, &again, &third, step);
    const struct forces fourth = joint_forces(joint, &end, sense);
    struct motion to = *from;
    to.angle += step / 6.0 * (from->speed + 2.0 * (middle.speed + again.speed) + end.speed);
    to.output += step / 6.0 * (from->output_speed + 2.0 * (middle.output_speed + again.output_speed) +
                               end.output_speed);
    to.speed += step / 6.0 *
                (first.acceleration + 2.0 * (second.acceleration + third.acceleration) + fourth.acceleration);
    to.output_speed += step / 6.0 * (first.load_acceleration + 2.0 * (second.load_acceleration +
                                                                       third.load_acceleration) +
                                     fourth.load_acceleration);
    to.jams = first.jams || second.jams || third.jams || fourth.jams;
    return to;
}

/* Part of a step after which the driver comes to rest or jams; none where it does at once. */
static double joint_stops(const struct joint *joint, double step, double sense)
{
    double low = 0.0, high = step;
    for (int k = 0; k < HALVINGS; ++k) {
        const double middle = 0.5 * (low + high);
        *(sense * joint_advanced(joint, middle, sense).speed > 0.0 ? &low : &high) = middle;
    }
    return low;
}

/* A rigid load follows its driver; teeth slide with the wind-up, and what they hold fades with the driver. */
static void joint_follow(struct joint *joint, double turned)
{
    double slope, bend;
    struct motion *now = &joint->now;
    if (JOINT_KNOTS) {
        const double wind_up = now->angle - now->output - joint_error(now->angle, &slope, &bend);
        now->slid = joint_slid(now, wind_up);
        if (JOINT_LOOP_TRAVEL > 0.0)
            now->slid *= exp(-fabs(turned) / JOINT_LOOP_TRAVEL);
        now->wind_up = wind_up;
        return;
    }
    joint->now.output = joint->now.angle - joint_error(joint->now.angle, &slope, &bend);
    joint->now.output_speed = joint->now.speed * (1.0 - slope);
}

static void joint_small_step(struct joint *joint, double step)
{
    for (int turns = 0; step > 0.0; ++turns) {
        const double before = joint->now.speed, angle = joint->now.angle;
        double sense = before == 0.0 ? joint_breaks(joint, &joint->now) : copysign(1.0, before), part = step;
        struct motion next = joint_advanced(joint, step, turns < CREEPS ? sense : 0.0);
        if ((next.jams || sense * next.speed < 0.0) && before == 0.0)
            next = joint_advanced(joint, step, sense = 0.0);
        if (next.jams || sense * next.speed < 0.0) {
            part = joint_stops(joint, step, sense);
            next = part > 0.0 ? joint_advanced(joint, part, sense) : joint->now;
            next.speed = 0.0;
        }
        joint->now = next;
        joint_follow(joint, joint->now.angle - angle);
        step = part < step ? step - part : 0.0;
    }
}

/* Longest step inside. */
static double joint_longest(const struct joint *joint)
{
    const double yields = 1.0 / joint_inertia(joint, INERTIA) + 1.0 / joint_inertia(joint, LOAD_INERTIA);
    const double damped = joint->inputs[DAMPING] * yields;
    const double order = fmax(JOINT_HIGHEST_ORDER, joint->inputs[RIPPLE] != 0.0 ? JOINT_FRICTION_ORDER : 0.0);
    const double waving = order * fabs(joint->now.speed);
    double step = LONGEST_STEP;
    if (JOINT_STIFFEST > 0.0)
        step = fmin(step, joint_turn / PARTS / sqrt(JOINT_STIFFEST * yields));
    if (damped * step > 0.1)
        step = 0.1 / damped;
    return waving * step > joint_turn / WAVE_PARTS ? joint_turn / WAVE_PARTS / waving : step;
}

static int joint_finite_motion(const struct motion *at)
{
    return isfinite(at->angle) && isfinite(at->speed) && isfinite(at->output) && isfinite(at->output_speed);
}

/* Advance by a step from outside; 0 where the state has no number any more, which is then as before. */
static int joint_step(struct joint *joint, double step)
{
    const struct motion before = joint->now;
    double left = step;
    if (!joint->started || !(step >= 0.0) || step > MOST_STEPS * joint_longest(joint))
        return 0;
    while (left > 0.0) {
        const double count = ceil(left / joint_longest(joint) - 1e-9), part = count > 1.0 ? left / count : left;
        joint_small_step(joint, part);
        if (!joint_finite_motion(&joint->now)) {
            joint->now = before;
            return 0;
        }
        left = count > 1.0 ? left - part : 0.0;
    }
    joint->time += step;
    return 1;
}

static void joint_begin(struct joint *joint)
{
    double slope, bend;
    const double *start = joint->inputs;
    const double error = joint_error(start[START_ANGLE], &slope, &bend);
    joint->now.jams = 0;
    joint->now.slid = 0.0;
    joint->now.wind_up = JOINT_KNOTS ? start[START_WIND_UP] : 0.0;
    joint->now.angle = start[START_ANGLE];
    joint->now.speed = start[START_SPEED];
    joint->now.output = start[START_ANGLE] - error - (JOINT_KNOTS ? start[START_WIND_UP] : 0.0);
    joint->now.output_speed =
        start[START_SPEED] * (1.0 - slope) - (JOINT_KNOTS ? start[START_WIND_UP_RATE] : 0.0);
}

static void joint_reset(struct joint *joint)
{
    for (int k = 0; k < SETTABLE; ++k)
        joint->inputs[k] = 0.0;
    joint->inputs[TEMPERATURE] = JOINT_TEMPERATURE;
    joint->inputs[INERTIA] = joint->inputs[LOAD_INERTIA] = JOINT_ARMATURE;
    joint->inputs[RIPPLE] = JOINT_FRICTION_WAVES > 0 ? 1.0 : 0.0;
    joint->time = 0.0;
    joint->started = 0;
    joint_begin(joint);
}

/* Whether a value may be set, and it is set. */
static int joint_set(struct joint *joint, unsigned number, double value)
{
    if (number >= SETTABLE || !isfinite(value))
        return 0;
    if (((number == INERTIA || number == LOAD_INERTIA) && value <= 0.0) || ((number == DAMPING || number == RIPPLE) && value < 0.0))
        return 0;
    if (number >= START_ANGLE && joint->started)
        return 0;
    joint->inputs[number] = value;
    if (number >= START_ANGLE)
        joint_begin(joint);
    return 1;
}

/* Whether it can start: nothing moves without inertia. */
static int joint_start(struct joint *joint)
{
    return joint->started = joint->inputs[INERTIA] > 0.0 && joint->inputs[LOAD_INERTIA] > 0.0;
}

static int joint_outside(const struct joint *joint, double torque, double sense)
{
    return loss_table_outside(sense * torque, fabs(joint->now.speed), joint->inputs[TEMPERATURE]);
}

static double joint_output(const struct joint *joint, unsigned number)
{
    const struct motion *now = &joint->now;
    if (number < SETTABLE)
        return joint->inputs[number];
    double sense = now->speed == 0.0 ? joint_breaks(joint, now) : copysign(1.0, now->speed);
    struct forces here = joint_forces(joint, now, sense);
    if (here.jams)
        here = joint_forces(joint, now, sense = 0.0);
    switch (number) {
    case ANGLE:
        return now->angle / LOSS_TABLE_SPEED_RATIO;
    case SPEED:
        return now->speed / LOSS_TABLE_SPEED_RATIO;
    case OUTPUT_ANGLE:
        return now->output;
    case OUTPUT_SPEED:
        return now->output_speed;
    case WIND_UP:
        return here.wind_up;
    case TORQUE:
        return here.torque;
    case FRICTION:
        return here.friction * LOSS_TABLE_SPEED_RATIO;
    case LOSS:
        return fabs(here.friction * now->speed);
    case STICKS:
        return sense == 0.0;
    default: /* at rest a torque may come to push along the motion or against it */
        return joint_outside(joint, here.torque, sense == 0.0 ? 1.0 : sense) ||
               (sense == 0.0 && joint_outside(joint, here.torque, -1.0));
    }
}

#endif
