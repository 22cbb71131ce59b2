"""What hapticgiant's driver does with a Franka, done by libfranka (pylibfranka); says JSON.

    reference_client.py HOST run|speeds|step|silence|stop|nothing [--thresholds JSON] [--load JSON]

run: torques for a second. speeds: speeds of the joints for a second. step: a step of 30 Nm. silence: no
commands for 0.3 s. stop: the motion is stopped by StopMove. nothing: no motion. Afterwards it
recovers, where that is needed. Runs in the environment that franka_test.py makes.
"""

import argparse
import json
import time

import pylibfranka

# what test and reader look for in the commands, Nm
TORQUES = [0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07]
SPEEDS = [0.001, -0.001, 0.002, -0.002, 0.003, -0.003, 0.001]  # rad/s
CYCLES = 1000
STEP = 30.0  # Nm


def lead_by_speeds(robot):
    control = robot.start_joint_velocity_control(pylibfranka.ControllerMode.JointImpedance)
    for cycle in range(CYCLES):
        control.readOnce()
        is_last = cycle == CYCLES - 1
        command = pylibfranka.JointVelocities([0.0] * 7 if is_last else SPEEDS)
        command.motion_finished = is_last
        control.writeOnce(command)


def lead(robot, what):
    control = robot.start_torque_control()
    for cycle in range(CYCLES):
        control.readOnce()
        command = pylibfranka.Torques(TORQUES)
        if what == "step" and cycle == 100:
            command = pylibfranka.Torques([STEP] + TORQUES[1:])
        if what == "silence" and cycle == 100:
            time.sleep(0.3)
        if what == "stop" and cycle == 100:
            robot.stop()
            return
        command.motion_finished = what == "run" and cycle == CYCLES - 1
        control.writeOnce(command)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("host")
    parser.add_argument("what", choices=("run", "step", "silence", "stop", "speeds", "nothing"))
    parser.add_argument("--thresholds", type=json.loads)
    parser.add_argument("--load", type=json.loads)
    options = parser.parse_args()
    robot = pylibfranka.Robot(options.host, pylibfranka.RealtimeConfig.kIgnore)
    if options.thresholds:
        robot.set_collision_behavior(*options.thresholds)
    if options.load:
        robot.set_load(*options.load)
    said = {"error": "", "errors": "", "mode": ""}
    try:
        if options.what == "speeds":
            lead_by_speeds(robot)
        elif options.what != "nothing":
            lead(robot, options.what)
    except RuntimeError as error:  # every exception of libfranka
        said["error"] = str(error)
    state = robot.read_once()
    said["errors"] = str(state.last_motion_errors)
    said["mode"] = state.robot_mode.name
    if state.robot_mode == pylibfranka.RobotMode.Reflex:
        robot.automatic_error_recovery()
        said["mode_after"] = robot.read_once().robot_mode.name
    print(json.dumps(said))


if __name__ == "__main__":
    main()
