// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace penumbra::app {

// What --help prints before and after the options.

inline constexpr const char* about =
    "Penumbra tells a robot which parts of its camera's view its own body hides.";

inline constexpr const char* main_examples = R"(
Examples:
  penumbra init folder/                      write the recording.yaml of your images
  penumbra run recording/ -o out             label every frame of a recording
  penumbra tune recording/ -o tuned          measure your sensor: tolerance, fringe, missing tools
  penumbra calibrate recording/ -o pose      find the camera's pose from the robot that it sees
  penumbra render --robot arm.urdf --camera camera_info.yaml --pose pose.csv -o vdi.npy
  penumbra inspect arm.urdf                  list which links of a URDF are drawn, and why not
  penumbra doctor                            what this machine offers: SIMD, OpenGL, versions
  penumbra simulate conveyor -o belt         record a simulated scene with its truth
  penumbra topics                            list the live topics of ROS 2's graph
  penumbra live                              label live topics, publish masks and targets
  penumbra play bag.mcap                     publish a bag on ROS 2's graph
  penumbra view recording/                   look at a recording in the browser
  penumbra view-planning recording/ --candidates poses.csv   find where cameras see targets
  penumbra look-ahead recording/ --trajectory plan.csv       say what a motion will hide, and when
  penumbra run --help                        all options of one command

Exit status: 0 done; 2 an error in the input (one line on stderr says where); 1 an internal error,
or a graphics device that failed; 130 stopped by Ctrl-C.)";

inline constexpr const char* run_examples = R"(
OUT gets report.json. --save adds for each frame, here 0:
  vdi/000000.npy       virtual depth in metres; 0: no robot, or the lens model does not reach
  labels/000000.png    0 clear, 1 front, 2 occluded, 3 unknown, 4 beyond, 5 fringe
  links/000000.png     link number in the report + 1; 0: none
  robot_mask/000000.png  255 where the robot is drawn, else 0
  overlay/000000.png   labels and targets over the colour image
  filtered/000000.png  depth without the robot, millimetres
  points/000000.pcd    points without the robot; points/000000.ply is the same
--report adds report.html, a page for the browser in one file. OUT.mcap is a bag of results: virtual
depth, labels, mask, depth and points without the robot, targets, overlays.
Results of an earlier run in OUT are replaced. A folder that holds other files is refused.
Faulty frames are listed on stderr and in the report; the other frames are judged.
For a bag the topics that are used are printed. Each image is judged with the pose at its own stamp.

Examples:
  penumbra run recording/ -o out
  penumbra run bag.mcap -o out --package ur_description=/opt/ur_description
  penumbra run bag.mcap -o results.mcap --target-topic /detections
  penumbra run recording/ -o out --save labels,overlay --frames 10:20
  penumbra run recording/ -o out --labels paper
  penumbra run recording/ -o out --tolerance 0.02,0,0.012 --front-min-width 0
  penumbra run recording/ -o out --renderer gl)";

inline constexpr const char* tune_examples = R"(
Measures a sensor on a recording in which the arm moves through free space in front of a camera that
does not move. Prints the tolerance and the fringe reach that fit it, as lines of recording.yaml and
as options of run. Prints also what moves with a link but is missing in the URDF: a tool, a cable, a
cover.
OUT gets tune.json (all numbers), tune.png (the frame with the most fringe: green is removed, red
stays) and extra_LINK.stl for each link with an extra part.

Examples:
  penumbra tune recording/ -o tuned
  penumbra tune bag.mcap -o tuned --package ur_description=/opt/ur_description)";

inline constexpr const char* calibrate_examples = R"(
Finds a camera's pose from the robot that it sees in depth, colour images or masks, without markers.
The camera is fixed in the cell, or to a link of the robot. Ten poses of the arm, near and far, left
and right, are enough. Prints the pose in several forms and how far off it may be. If the frames
show too little, or not this robot, it says so and what to record, with exit status 2.
OUT gets camera_pose.csv (only a good one), calibration.json (all numbers) and report.html: the
result, residuals by frame and by link, and pictures before and after.
With --masks the pose is that of the colour image; frames without a mask are left out. A recording
without depth, or a bag with --no-depth, is calibrated by its colour images (--images, of a camera
that stands still) or by masks alone.

Examples:
  penumbra calibrate recording/ -o calibrated
  penumbra calibrate recording/ --initial rough_pose.csv -o calibrated
  penumbra calibrate images/ --search --images -o calibrated
  penumbra calibrate images/ --search --masks mask_%d.png -o calibrated
  penumbra calibrate bag.mcap --search -o calibrated)";

inline constexpr const char* view_examples = R"(
Judges a recording or a bag as run does, and serves a page that shows the result meanwhile: robot,
camera and points in 3-D, images with their labels, targets over time. The address to open is
printed. Images are kept in a temporary file in TMPDIR, else /var/tmp, until the program ends.
For a folder that run wrote, its report and the images of --save are shown. The page says how to get
the rest. penumbra live --port serves the same page. Ctrl-C ends it.

Examples:
  penumbra view recording/
  penumbra view bag.mcap --package ur_description=/opt/ur_description --port 0
  penumbra view recording/ --labels paper
  penumbra view out                          what penumbra run ... -o out wrote
  penumbra view recording/ --address 0.0.0.0)";

inline constexpr const char* init_examples = R"(
Looks at FOLDER and three levels below it, and writes FOLDER/recording.yaml: images by their pattern
(depth_%d.png), videos, the joint file that fits the URDF, camera_info, the camera's pose. Prints
what is missing or was guessed, and the next command. A ROS bag needs none.

Examples:
  penumbra init my_recording/
  penumbra init my_recording/ --robot arm.urdf --package arm_description=/opt/arm_description)";

inline constexpr const char* view_planning_examples = R"(
Renders the robot and what it carries, as it moved in a recording or bag, for each pose where a
camera could be mounted. Prints in which share of the frames each target is visible, partly hidden,
hidden by the robot, or out of view (outside the image or the camera's range), and the set of K
cameras of which most often at least one sees each target. Depth images are not used, so other things
hide nothing. The intrinsics are the input's.
OUT gets view_planning.json (all numbers, and verdicts by frame) and report.html: heat maps of
candidates and targets, over all frames and over time.

Examples:
  penumbra view-planning recording/ --candidates poses.csv --targets targets.yaml -o plan
  penumbra view-planning bag.mcap --candidates poses.csv --targets targets.yaml --cameras 3 -o plan)";

inline constexpr const char* look_ahead_examples = R"(
Says for each target when a planned motion of the robot will hide it, for how long, and by which
link, if nothing else moves. INPUT gives robot, cameras and targets; the motion begins in one of its
frames. Joints that the motion does not name stay where they are. FILE is a table with the header
time,JOINT,... (seconds, rad and m); or a message of JointTrajectory, RobotTrajectory or
DisplayTrajectory as `ros2 topic echo` prints it. Between points the robot moves as
joint_trajectory_controller moves it. Without FILE the motion is the one that a bag's topic
display_planned_path, or --plan-topic, has at that frame. Several motions are ranked by how long targets stay visible.
OUT gets look_ahead.json (all numbers) and report.html: timelines, and pictures of the moments when
targets are hidden.

Examples:
  penumbra look-ahead recording/ --trajectory plan.csv -o ahead
  ros2 topic echo --once --full-length /display_planned_path > plan.yaml
  penumbra look-ahead bag.mcap --targets targets.yaml --trajectory plan.yaml --from 120
  penumbra look-ahead recording/ --trajectory left.csv --trajectory right.csv)";

inline constexpr const char* render_examples = R"(
Joints that are not given are at rest (0, or no rotation); --json lists every position.
Distortion in the camera_info bends the image as the lens does. For images that are rectified
already (recordings with camera.rectified) add --rectified.
Planar joints take NAME/x, NAME/y, NAME/yaw; floating ones NAME/x, y, z, qx, qy, qz, qw.
--repeat renders the same pose N more times, and labels the virtual depth image itself each time, as
if the sensor saw only the robot.

Examples:
  penumbra render --robot ur5e.urdf --package ur_description=/opt/ur_description \
      --camera camera_info.yaml --pose pose.csv --joint elbow_joint=1.57 -o vdi.npy
  penumbra render --robot arm.urdf --camera camera_info.yaml --pose pose.csv --parent tool0 \
      -o vdi.npy --links links.png --repeat 200 --json)";

inline constexpr const char* inspect_examples = R"(
Examples:
  penumbra inspect arm.urdf
  penumbra inspect ur5e.urdf --package ur_description=/opt/ur_description --json)";

inline constexpr const char* doctor_examples = R"(
Prints versions, SIMD targets, OpenGL devices and their faults, the renderers that work on this
machine, and whether sockets can hold enough for live images. Without OpenGL the exit status is 0,
too.

Examples:
  penumbra doctor
  penumbra doctor --json)";

inline constexpr const char* simulate_examples = R"(
Scenes: conveyor (a printed parcel on a belt, an arm that sweeps over it and grasps it), handover (a
person's hand behind and in front of the arm), random (targets in front of, behind and next to an
arm in a new pose in every frame). MuJoCo places and draws everything. OUT is a recording for
penumbra run, with the truth next to it: ids/000000.png (0 nothing, 1 + link number, from 10000
objects), truth.csv (poses, pixels seen and hidden), true_joint_states.csv, scene.yaml. OUT.mcap is
the same as a bag of ROS 2, with the truth on /truth/... and the arm's meshes next to it in
arm_description/.
The same seed gives the same bytes.

Examples:
  penumbra simulate conveyor -o belt
  penumbra simulate handover --seed 7 --joint-sigma 0.001 --joint-latency 0.01 -o hand
  penumbra simulate random --seed 3 --no-noise --frames 0:100 -o targets
  penumbra simulate conveyor -o belt.mcap && penumbra run belt.mcap -o out)";

inline constexpr const char* live_examples = R"(
Takes robot_description, joint_states, tf and a depth camera's topics from ROS 2's graph, and judges
each image with the robot's pose at its own stamp. Publishes below /penumbra (with --camera below
/penumbra/NAME): vdi, labels, mask, filtered_depth, points, targets, overlay/compressed, robot_mask, each only
while somebody subscribes to it. /diagnostics says once a second why nothing is published. What is
not known is published as unknown. --port serves the viewer's page of each camera. Ctrl-C and
SIGTERM end it; after --duration its exit status is 2 if it judged nothing.
ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY=1 and CYCLONEDDS_URI are used.

Examples:
  penumbra live --package ur_description=/opt/ur_description --port 8470
  penumbra live --depth-topic /camera/camera/depth/image_rect_raw --target-topic /detections
  penumbra live --camera left=/left/depth/image_rect_raw --camera right=/right/depth/image_rect_raw
  penumbra live --cloud "/ouster/points sensor=ouster_os1" --cloud "/scan sensor=hokuyo"
  penumbra live --namespace cell --remap /tf:=/cell/tf --publish mask,targets --summary live.json)";

inline constexpr const char* cloud_examples = R"(
INPUT is a bag with PointCloud2, LaserScan or Livox's CustomMsg, or a recording folder whose
recording.yaml has `sensor` and `frames.cloud` (docs/point_clouds.md). Points that are neither clear nor front
are removed: in organised clouds and scans they become NaN. OUT is a bag with topics
/penumbra/TOPIC, or a folder with files of the same names and report.json. Points of clouds whose
poses are not known are all removed. Exit status 2: no cloud was labelled, or --tune advises nothing.

Examples:
  penumbra cloud walk.mcap -o walk_clean.mcap --sensor ouster_os1
  penumbra cloud bag.mcap -o clean.mcap --topic /scan --removed-ranges inf
  penumbra cloud scans -o clean
  penumbra cloud scans -o labelled --label
  penumbra cloud walk.mcap --port 8470        # shows the labels, and writes nothing)";

inline constexpr const char* topics_examples = R"(
Lists what other programs publish and subscribe to, with QoS. Programs whose QoS or type differ do
not receive each other's messages. Other machines and ROS_DOMAIN_ID are handled as ROS 2 does;
ROS_LOCALHOST_ONLY=1 and CYCLONEDDS_URI are used.

Examples:
  penumbra topics
  penumbra topics --domain 7 --wait 5 --json)";

inline constexpr const char* play_examples = R"(
Publishes the bag's messages unchanged, at the pace at which they were recorded, with QoS reliable.
Prints the topics, and at the end what was not published. Ctrl-C ends it.

Examples:
  penumbra play bag.mcap
  penumbra play bag.mcap --loop --restamp
  penumbra play bag.mcap --rate 0.5 --start 10 --topics /tf,/tf_static,/camera/depth/image_raw
  penumbra play bag.mcap --remap /joint_states:=/arm/joint_states --domain 7)";

}  // namespace penumbra::app
