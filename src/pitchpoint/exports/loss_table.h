/* Corners of the cell around a value. */
struct loss_table_cell {
    int low, high;
    double weight;
};

static struct loss_table_cell loss_table_cell(const double *axis, int count, double value)
{
    struct loss_table_cell cell = {0, 0, 0.0};
    for (int left = count - 1; left > 1; left -= left / 2) /* without branches that a processor has to guess */
        cell.low += value >= axis[cell.low + left / 2] ? left / 2 : 0;
    cell.high = count > 1 ? cell.low + 1 : 0;
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
    const double *first = loss_table_loss_torques[law][torque.low][speed];
    const double *second = loss_table_loss_torques[law][torque.high][speed];
    return loss_table_mixed(
        loss_table_mixed(first[temperature.low], first[temperature.high], temperature.weight),
        loss_table_mixed(second[temperature.low], second[temperature.high], temperature.weight),
        torque.weight);
}

/* Torque that is lost, along the motion of the output; negative where friction locks the drive. */
static double loss_table_lost(double torque, double speed, double temperature, int law)
{
    const double *moving = loss_table_speeds + 1;
    const struct loss_table_cell t = loss_table_cell(loss_table_torques, LOSS_TABLE_TORQUES, torque);
    const struct loss_table_cell oil =
        loss_table_cell(loss_table_temperatures, LOSS_TABLE_TEMPERATURES, temperature);
    if (speed == 0.0)
        return loss_table_column(law, t, 0, oil);
    struct loss_table_cell n = loss_table_cell(moving, LOSS_TABLE_SPEEDS - 1, speed);
    if (n.weight > 0.0 && n.weight < 1.0)
        n.weight = log(speed / moving[n.low]) / log(moving[n.high] / moving[n.low]);
    return loss_table_mixed(loss_table_column(law, t, n.low + 1, oil),
                            loss_table_column(law, t, n.high + 1, oil), n.weight);
}

static int loss_table_outside(double torque, double speed, double temperature)
{
    const double *torques = loss_table_torques, *degrees = loss_table_temperatures;
    return !(torque >= torques[0] && torque <= torques[LOSS_TABLE_TORQUES - 1] &&
             speed <= loss_table_speeds[LOSS_TABLE_SPEEDS - 1] && temperature >= degrees[0] &&
             temperature <= degrees[LOSS_TABLE_TEMPERATURES - 1]);
}

/* Number of a law by its name; -1 where there is none. */
static inline int loss_table_law(const char *name)
{
    for (int law = 0; law < LOSS_TABLE_LAWS; ++law)
        if (strcmp(name, loss_table_law_names[law]) == 0)
            return law;
    return -1;
}

/* State at a torque and speed of the output with their signs; law counts from 0. At a speed of 0 torque of the
 * driver and efficiency are NaN: loss_table_at_rest has the band of torques under which the drive stands. */
static inline struct loss_table_point loss_table_at(double torque, double speed, double temperature, int law)
{
    struct loss_table_point found = {NAN, NAN, NAN, 0, 0};
    const double along = speed >= 0.0 ? torque : -torque, pace = fabs(speed);
    if (law < 0 || law >= LOSS_TABLE_LAWS)
        return found;
    found.outside = loss_table_outside(along, pace, temperature);
    if (isnan(along) || isnan(pace) || isnan(temperature))
        return found;
    const double lost = loss_table_lost(along, pace, temperature, law), driving = along + lost;
    if (lost < 0.0) {
        found.locked = 1;
        return found;
    }
    found.loss = lost * pace;
    if (speed != 0.0) {
        found.input_torque = copysign(driving * LOSS_TABLE_SPEED_RATIO, speed * driving);
        if (along > 0.0 && driving > 0.0)
            found.efficiency = along / driving;
        else if (along < 0.0 && driving < 0.0)
            found.efficiency = driving / along;
    }
    return found;
}

/* The same at many points. */
static inline void loss_table_at_many(int count, const double *torque, const double *speed,
                                      const double *temperature, int law, struct loss_table_point *found)
{
    for (int k = 0; k < count; ++k)
        found[k] = loss_table_at(torque[k], speed[k], temperature[k], law);
}

/* Torque that is lost at rest with as little or as much as the spread gives; negative where friction locks. */
static double loss_table_bound(double torque, double temperature, int law, int most)
{
    const struct loss_table_cell t = loss_table_cell(loss_table_torques, LOSS_TABLE_TORQUES, torque);
    const struct loss_table_cell oil =
        loss_table_cell(loss_table_temperatures, LOSS_TABLE_TEMPERATURES, temperature);
    const double *first = loss_table_rest_bounds[law][most][t.low];
    const double *second = loss_table_rest_bounds[law][most][t.high];
    return loss_table_mixed(loss_table_mixed(first[oil.low], first[oil.high], oil.weight),
                            loss_table_mixed(second[oil.low], second[oil.high], oil.weight), t.weight);
}

/* Torques of the driver between which the drive stands still with a load; law counts from 0. */
static inline struct loss_table_rest loss_table_at_rest(double torque, double temperature, int law)
{
    struct loss_table_rest found = {NAN, NAN, 0, 0, NAN, NAN, NAN, NAN};
    if (law < 0 || law >= LOSS_TABLE_LAWS)
        return found;
    found.outside =
        loss_table_outside(torque, 0.0, temperature) || loss_table_outside(-torque, 0.0, temperature);
    if (isnan(torque) || isnan(temperature))
        return found;
    const double forwards = loss_table_lost(torque, 0.0, temperature, law);
    const double back = loss_table_lost(-torque, 0.0, temperature, law);
    found.locked = forwards < 0.0 || back < 0.0;
    if (!(forwards < 0.0))
        found.highest = (torque + forwards) * LOSS_TABLE_SPEED_RATIO;
    if (!(back < 0.0))
        found.lowest = (torque - back) * LOSS_TABLE_SPEED_RATIO;
    for (int most = 0; most < 2; ++most) {
        const double on = loss_table_bound(torque, temperature, law, most);
        const double off = loss_table_bound(-torque, temperature, law, most);
        if (!(on < 0.0))
            *(most ? &found.highest_high : &found.highest_low) = (torque + on) * LOSS_TABLE_SPEED_RATIO;
        if (!(off < 0.0))
            *(most ? &found.lowest_low : &found.lowest_high) = (torque - off) * LOSS_TABLE_SPEED_RATIO;
    }
    return found;
}

#endif
