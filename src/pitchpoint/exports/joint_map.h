/* Loss map of a drive: no state, outputs follow inputs at once. */
#ifndef JOINT_MAP_H
#define JOINT_MAP_H

enum { TORQUE, SPEED, TEMPERATURE, LOSS, EFFICIENCY, INPUT_TORQUE, LOWEST, HIGHEST, REALS };
enum { LOCKED = REALS, OUTSIDE, ALL };

#define UNBOUNDED 1e30 /* stands for a torque that no torque of the driver reaches */

struct joint {
    double inputs[3];
    double time;
};

static double joint_finite(double value, double otherwise)
{
    return isnan(value) ? otherwise : value;
}

/* Outputs by their value references; what has no number has the stand-in of modelDescription.xml. */
static double joint_output(const struct joint *joint, unsigned number)
{
    const double torque = joint->inputs[TORQUE], speed = joint->inputs[SPEED];
    const double temperature = joint->inputs[TEMPERATURE];
    const struct loss_table_point here = loss_table_at(torque, speed, temperature, JOINT_LAW);
    const struct loss_table_rest rest = loss_table_at_rest(torque, temperature, JOINT_LAW);
    const double ideal = torque * LOSS_TABLE_SPEED_RATIO;
    switch (number) {
    case LOSS:
        return joint_finite(here.loss, 0.0);
    case EFFICIENCY:
        return joint_finite(here.efficiency, 0.0);
    case INPUT_TORQUE:
        if (speed == 0.0)
            return 0.5 * (joint_finite(rest.lowest, ideal) + joint_finite(rest.highest, ideal));
        return joint_finite(here.input_torque, 0.0);
    case LOWEST:
        return joint_finite(rest.lowest, -UNBOUNDED);
    case HIGHEST:
        return joint_finite(rest.highest, UNBOUNDED);
    case LOCKED:
        return speed == 0.0 ? rest.locked : here.locked;
    case OUTSIDE:
        return here.outside;
    default:
        return joint->inputs[number];
    }
}

static void joint_reset(struct joint *joint)
{
    joint->inputs[TORQUE] = joint->inputs[SPEED] = joint->time = 0.0;
    joint->inputs[TEMPERATURE] = JOINT_TEMPERATURE;
}

/* Whether a value may be set, and it is set. */
static int joint_set(struct joint *joint, unsigned number, double value)
{
    if (number > TEMPERATURE || isnan(value))
        return 0;
    joint->inputs[number] = value;
    return 1;
}

static int joint_start(struct joint *joint)
{
    (void)joint;
    return 1;
}

static int joint_step(struct joint *joint, double step)
{
    joint->time += step;
    return 1;
}

#endif
