/* Corners of the cell around a value. */
struct loss_table_cell {
    int low, high;
    double weight;
};

static struct loss_table_cell loss_table_cell(const double *axis, int count, double value)
{
    struct loss_table_cell cell = {0, count > 1 ? 1 : 0, 0.0};
    while (cell.high < count - 1 && value >= axis[cell.high]) {
        cell.low += 1;
        cell.high += 1;
    }
    if (cell.low != cell.high && !(value <= axis[cell.low])) {
        cell.weight = (value - axis[cell.low]) / (axis[cell.high] - axis[cell.low]);
        if (cell.weight > 1.0)
            cell.weight = 1.0;
    }
    return cell;
}

static double loss_table_mixed(double first, double second, double weight)
{
    if (weight == 0.0)
        return first;
    if (weight == 1.0)
        return second;
    return first < 0.0 || second < 0.0 ? -1.0 : first + weight * (second - first);
}

static double loss_table_column(int law, struct loss_table_cell torque, int speed,
                                struct loss_table_cell temperature)
{
    const double *first = loss_table_losses[law][torque.low][speed];
    const double *second = loss_table_losses[law][torque.high][speed];
    return loss_table_mixed(
        loss_table_mixed(first[temperature.low], first[temperature.high], temperature.weight),
        loss_table_mixed(second[temperature.low], second[temperature.high], temperature.weight),
        torque.weight);
}

/* Number of a law by its name; -1 where there is none. */
static inline int loss_table_law(const char *name)
{
    for (int law = 0; law < LOSS_TABLE_LAWS; ++law)
        if (strcmp(name, loss_table_law_names[law]) == 0)
            return law;
    return -1;
}

/* State at a torque and speed of the output with their signs; law counts from 0. */
static inline struct loss_table_point loss_table_at(double torque, double speed, double temperature, int law)
{
    struct loss_table_point found = {NAN, NAN, NAN, 0, 0};
    const double along = speed >= 0.0 ? torque : -torque, pace = fabs(speed);
    const double *torques = loss_table_torques, *speeds = loss_table_speeds;
    const double *degrees = loss_table_temperatures;
    if (law < 0 || law >= LOSS_TABLE_LAWS)
        return found;
    found.outside = !(along >= torques[0] && along <= torques[LOSS_TABLE_TORQUES - 1] &&
                      pace <= speeds[LOSS_TABLE_SPEEDS - 1] && temperature >= degrees[0] &&
                      temperature <= degrees[LOSS_TABLE_TEMPERATURES - 1]);
    if (isnan(along) || isnan(pace) || isnan(temperature))
        return found;
    const struct loss_table_cell t = loss_table_cell(torques, LOSS_TABLE_TORQUES, along);
    const struct loss_table_cell n = loss_table_cell(speeds, LOSS_TABLE_SPEEDS, pace);
    const struct loss_table_cell oil = loss_table_cell(degrees, LOSS_TABLE_TEMPERATURES, temperature);
    const double low = loss_table_column(law, t, n.low, oil), high = loss_table_column(law, t, n.high, oil);
    double loss = loss_table_mixed(low, high, n.weight);
    if (n.low == 0 && n.weight > 0.0 && n.weight < 1.0 && LOSS_TABLE_SPEEDS > 2) {
        const double beyond = loss_table_column(law, t, LOSS_TABLE_SPEEDS > 2 ? 2 : 0, oil);
        if (high > 0.0 && beyond > high)
            loss = high * pow(n.weight, fmax(log(beyond / high) / log(speeds[2] / speeds[1]), 1.0));
    }
    if (loss < 0.0) {
        found.locked = 1;
        return found;
    }
    found.loss = loss;
    if (speed != 0.0) {
        const double given = torque * speed, taken = given + loss;
        found.input_torque = taken / (speed / LOSS_TABLE_SPEED_RATIO);
        if (given > 0.0 && taken > 0.0)
            found.efficiency = given / taken;
        else if (given < 0.0 && taken < 0.0)
            found.efficiency = taken / given;
    }
    return found;
}

#endif
