"""Steps the control cycle of the door with sensors of one's own, and finds when it opens."""

import hapticgiant as hg

door = hg.load_scenario("door")
cycle = hg.Cycle(door)
device = hg.SimulatedDevice(door)  # put your own robot or simulator here
operator = hg.OperatorFrame()
hinge = 0.0
while hinge < 0.1:
    sensors = device.read()  # every field can be set from numpy
    command, record = cycle.step(sensors, operator)
    device.write(command)
    operator.request = hg.next_request(record, cycle.is_held(sensors))
    hinge = record.twin.q_a[0]
felt = door.limits[record.felt_limit].name if record.felt_limit >= 0 else "nothing"
print(f"opens at {record.time_s:.2f} s, force {record.robot.w_h[:3]} N, felt: {felt}")
