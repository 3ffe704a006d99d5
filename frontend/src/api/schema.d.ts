export type paths = Record<string, never>;
export type webhooks = Record<string, never>;
export interface components {
    schemas: {
        /** @description A motor: peak torque at standstill that falls linearly to zero at its top speed. */
        Actuator: {
            /** @description peak torque [Nm] */
            torque: number;
            /** @description no-load speed [rad/s] */
            speed: number;
            /** @description reflected rotor inertia [kg m^2] */
            armature: number;
            /** @description viscous friction [Nm s/rad] */
            damping: number;
            /** @description torque that it holds without end [Nm] */
            continuous?: number | null;
        };
        /** @description Motors of the leg joints (`leg`, or `thigh` and `calf` where they differ) and the wheels. */
        Actuators: {
            leg?: components["schemas"]["Actuator"] | null;
            thigh?: components["schemas"]["Actuator"] | null;
            calf?: components["schemas"]["Actuator"] | null;
            wheel: components["schemas"]["Actuator"];
        };
        /** @description A mass that the plan does not know of. */
        AddedPayload: {
            /** @description kg */
            mass: number;
            /** @description of its mass centre in the trunk's frame; on top if empty [m] */
            place?: number[] | null;
        };
        /**
         * @description What to make small or large: a number that varies, `mass`, a result, or a border.
         *
         *     With `between` and `tolerance` it is the last value of a quantity of the terrain, such as
         *     step.height, that a design passes; at most one aim is such a border.
         */
        Aim: {
            minimise?: string | null;
            maximise?: string | null;
            between?: number[] | null;
            tolerance?: number | null;
        };
        /** @description A study that needs no axes of its own: designs are one, and a border may be another. */
        Ask: {
            /**
             * @default stairwright/study/1
             * @constant
             */
            schema: "stairwright/study/1";
            /** @default  */
            name: string;
            /** @default  */
            description: string;
            /** @description a name, a document, or a kind with measures; by the axes if empty */
            terrain?: (string | components["schemas"]["StairParameters"] | components["schemas"]["RampParameters"] | components["schemas"]["FlatParameters"] | components["schemas"]["Terrain"]) | null;
            /** @default a1_wheeled */
            robot: string | components["schemas"]["Robot"];
            /**
             * @description documents of the robots that an axis `robot` names
             * @default {}
             */
            robots: {
                [key: string]: components["schemas"]["Robot"];
            };
            /** @description the terrain's own by default */
            friction?: number | null;
            /**
             * @default path
             * @enum {string}
             */
            method: "path" | "critical" | "nominal";
            /** @default {} */
            weights: {
                [key: string]: boolean | number;
            };
            /**
             * @description of plans of the method path, as for a plan
             * @default steady
             * @enum {string}
             */
            timing: "steady" | "fast";
            /** @description which end of the robot leads, as for a plan */
            facing?: ("forward" | "backward" | "either") | null;
            /** @description that plans of the method path shall stand; axes may vary it */
            tolerance?: components["schemas"]["Tolerance"] | null;
            /** @default [] */
            axes: components["schemas"]["Axis"][];
            /**
             * @default plan
             * @enum {string}
             */
            compute: "plan" | "rollout" | "trials";
            /**
             * @description of which cells without a way is found out what would open it, which takes most of their time: all, those at the last value of the boundary axis, or none
             * @default all
             * @enum {string}
             */
            diagnose: "all" | "last" | "none";
            /**
             * @description of rollouts and trials
             * @default {}
             */
            controller: {
                [key: string]: unknown;
            };
            /** @default 0 */
            seed: number;
            /**
             * @default {
             *       "count": 29
             *     }
             */
            trials: components["schemas"]["TrialSettings"];
        };
        /**
         * @description One axis: `values`, or `from`, `to` and `count`, or `boundary` and `tolerance`.
         *
         *     A boundary axis is searched for where the outcome changes instead of filled: by bisection over
         *     the values that divide its range into equal parts of at most `tolerance`.
         */
        Axis: {
            /** @description what varies: stairs.rise, stairs.run, step.height, ramp.slope, friction, payload, speed, weights.NAME, robot, or a number of the robot's file as robot.calf.length */
            name: string;
            values?: (string | number)[] | null;
            from?: number | null;
            to?: number | null;
            count?: number | null;
            /** @description range in which the outcome changes once */
            boundary?: number[] | null;
            /** @description of the place where it changes */
            tolerance?: number | null;
        };
        /** @description An axis of a study. */
        AxisDocument: {
            name: string;
            /** @description of the values; 1 for ratios and words */
            unit: string;
            /** @description all of them, in order */
            values: (number | string)[];
            /** @description searched for where the outcome changes, not filled */
            boundary: boolean;
        };
        /** @description The least margin, each taken against what it is a margin of, and where it is. */
        Binding: {
            /** @enum {string} */
            quantity: "clearance" | "com" | "friction" | "torque" | "wheel_torque" | "joint_limit";
            /** @description m, Nm, rad, or of the friction */
            value: number;
            /** @description [m] */
            progress: number;
        };
        Body_get_mesh_heights: {
            /**
             * Format: binary
             * @description STL, OBJ, PLY or OFF
             */
            file: string;
            /**
             * @description metres per unit of a mesh
             * @default 1
             */
            scale: number;
            /**
             * @description the axis of a mesh that points up
             * @default z
             * @enum {string}
             */
            up: "z" | "y";
        };
        Body_import_robot: {
            /**
             * Format: binary
             * @description URDF, MJCF, a zip with the meshes, or our YAML or JSON
             */
            file: string;
            /**
             * @description lock the legs outward from upright by [rad]
             * @default 0
             */
            abduction: number;
            /** @description where the file does not show it [m] */
            wheel_radius?: number | null;
            /** @description JOINT=RAD: a joint that is rigid there, by the file's name; may be given again */
            hold?: string[] | null;
        };
        Body_import_terrain: {
            /**
             * Format: binary
             * @description STL, OBJ, PLY, OFF, CSV, JSON or YAML
             */
            file: string;
            /** @description the file's by default */
            name?: string | null;
            friction?: number | null;
            /**
             * @description of a mesh that becomes 0 [m]
             * @default 0
             */
            x: number;
            /** @description of the cut [m]; by default the middle */
            y?: number | null;
            /**
             * @description of the cut [rad]
             * @default 0
             */
            heading: number;
            /**
             * @description metres per unit of a mesh
             * @default 1
             */
            scale: number;
            /**
             * @description the axis of a mesh that points up
             * @default z
             * @enum {string}
             */
            up: "z" | "y";
        };
        /** @description One design that was tried. */
        Candidate: {
            /** @description of what varies */
            values: {
                [key: string]: number;
            };
            /** @description None where it does not pass */
            aims: {
                [key: string]: number | null;
            };
            passed: boolean;
            /**
             * @description why it does not pass
             * @default
             */
            reason: string;
            /**
             * @description no other one is as good in all aims, better in one
             * @default false
             */
            best: boolean;
            /** @description of the best ones */
            robot?: components["schemas"]["Robot"] | null;
        };
        /** @description One cell of a study. */
        CellDocument: {
            cell: number;
            /** @description of the axes, by name */
            values: {
                [key: string]: number | string;
            };
            /** @description body of POST /plans for this cell; null where its values make no question */
            plan: {
                [key: string]: unknown;
            } | null;
            /** @description the variables of the dataset */
            record: {
                [key: string]: unknown;
            };
        };
        /**
         * @description Outcome of the independent exact check of the poses and of the motion between them.
         *
         *     The motion between sparse poses takes many times as long to judge as the poses: `motion` is
         *     found when it is first read, written or compared. The document always has it.
         */
        Certificate: {
            passed: boolean;
            /**
             * @default motion
             * @enum {string}
             */
            scope: "motion" | "poses";
            /** @description what stops the motion between poses, where only these are certified */
            motion?: components["schemas"]["Problem"] | null;
            /** @default [] */
            checks: components["schemas"]["Check"][];
        };
        /** @description One line of the certificate: the worst value, the bound it must keep, and where. */
        Check: {
            name: string;
            value: number;
            bound: number;
            unit: string;
            passed: boolean;
            /** @description where the worst value stands [m] */
            progress?: number | null;
        };
        /** @description Where the paper's collision points sit on trunk and links. */
        CollisionPoints: {
            /** @description (x, z) in trunk sizes from the centre, -0.5..0.5 */
            trunk: number[][];
            /** @description fractions of the thigh from the hip */
            thigh: number[];
            /** @description fractions of the calf from the knee */
            calf: number[];
        };
        /** @description How the robot is driven along its plan. Equation numbers are the paper's. */
        ControllerSettings: {
            /**
             * @description contact: forces at the contact points, in each wheel's own frame, wheel torque fed forward. paper: forces at the wheel centres, wheel torque from the rolling control alone (eqs 3-16)
             * @default contact
             * @enum {string}
             */
            form: "contact" | "paper";
            /**
             * @description Solves the balance QP (eqs 11-12): native is part of the control loop; clarabel, through qpsolvers, is the reference
             * @default native
             * @enum {string}
             */
            solver: "native" | "clarabel";
            /**
             * @description What the controller knows of its state. robot: what encoders, motor currents and an inertial sensor tell, by an estimator that knows the map (form contact, native solver). ideal: all of it, as the simulation has it; the default of form paper and of the clarabel solver, which have no estimator
             * @default robot
             * @enum {string}
             */
            sensing: "ideal" | "robot";
            /** @description Along the course; the plan's own timing if empty */
            speed?: number | null;
            /**
             * @description Cap on joint rates along the plan
             * @default 1.5
             */
            joint_speed: number;
            /** @description How far the plan may run ahead of the wheels; 30 mm if empty where the robot senses by itself, else 12 mm */
            maximum_lead?: number | null;
            /** @description K_p of eq 27; the robot's if empty */
            joint_stiffness?: number | null;
            /** @description K_d of eq 27; the robot's if empty */
            joint_damping?: number | null;
            /** @description K_d of eq 14; the robot's if empty */
            wheel_damping?: number | null;
            /**
             * @description Pull of each wheel to its place
             * @default 5
             */
            wheel_sync: number;
            /**
             * @description K_d of eq 16, per wheel radius and track
             * @default 1.2
             */
            yaw_damping: number;
            /**
             * @description Turns the robot back to the course
             * @default 4
             */
            heading_stiffness: number;
            /**
             * @description K_p of eq 8, position
             * @default 40
             */
            com_stiffness: number;
            /**
             * @description K_d of eq 8, position
             * @default 8
             */
            com_damping: number;
            /**
             * @description K_p of eq 8, pitch
             * @default 200
             */
            pitch_stiffness: number;
            /**
             * @description K_d of eq 8, pitch
             * @default 14
             */
            pitch_damping: number;
            /**
             * @description Learns a moment that the model does not know, e.g. of a shifted load (form contact)
             * @default 300
             */
            pitch_integral: number;
            /**
             * @description Left wheels push more than right ones where the robot leans to the left (form contact)
             * @default 100
             */
            roll_stiffness: number;
            /**
             * @description The same against the rate of roll
             * @default 14
             */
            roll_damping: number;
            /**
             * @description S of eq 11 for the force rows
             * @default 1
             */
            force_weight: number;
            /**
             * @description S of eq 11 for the moment row
             * @default 20
             */
            moment_weight: number;
            /**
             * @description Weight of the forces (eq 11); form contact: of their distance from the plan's static ones
             * @default 0.001
             */
            alpha: number;
            /**
             * @description Weight of the change of forces (eq 11)
             * @default 0.0001
             */
            beta: number;
            /**
             * @description Part of the friction that the QP may use; all of it where the plan itself needs more
             * @default 0.95
             */
            friction_share: number;
            /** @description Largest normal force of a wheel (eq 12); 1.3 times the robot's weight if empty */
            force_limit?: number | null;
        };
        /**
         * @description A design study (``stairwright/design/1``).
         *
         *     A design is a robot with numbers of its file changed. It counts where every cell of `ask`, a
         *     study without the robot's own axes, passes: plans, rollouts or trials, as that computes.
         */
        Design: {
            /**
             * @default stairwright/design/1
             * @constant
             */
            schema: "stairwright/design/1";
            /** @default  */
            name: string;
            /** @default  */
            description: string;
            /** @description what each design has to pass */
            ask: components["schemas"]["Ask"];
            vary: components["schemas"]["Vary"][];
            aims: components["schemas"]["Aim"][];
            /**
             * @description how many to try
             * @default 200
             */
            designs: number;
            /**
             * @description designs tried at once
             * @default 8
             */
            generation: number;
            /**
             * @description of what is proposed
             * @default 0
             */
            seed: number;
        };
        /** @description What a search has found, as `stairwright design -o` writes it, and how far it is. */
        DesignAnswer: {
            /** @description null where `stairwright design` is at it, or was: this service does not know */
            state: ("queued" | "running" | "done" | "failed" | "cancelled") | null;
            progress: number;
            /** @description seconds until it is done, by its own pace so far */
            eta: number | null;
            /** @description what is done before its first designs; empty from then on */
            stage: string;
            /** @description by another version of the planner than this service's */
            outdated: boolean;
            /** @description a problem document, when failed */
            error: {
                [key: string]: unknown;
            } | null;
            links: {
                [key: string]: string;
            };
            /**
             * @default stairwright/design-result/1
             * @constant
             */
            schema: "stairwright/design-result/1";
            id: string;
            design: components["schemas"]["Design"];
            complete: boolean;
            candidates: components["schemas"]["Candidate"][];
        };
        /** @description A search in a list, and how far it is. */
        DesignDocument: {
            /** @description null where `stairwright design` is at it, or was: this service does not know */
            state: ("queued" | "running" | "done" | "failed" | "cancelled") | null;
            progress: number;
            /** @description seconds until it is done, by its own pace so far */
            eta: number | null;
            /** @description what is done before its first designs; empty from then on */
            stage: string;
            /** @description by another version of the planner than this service's */
            outdated: boolean;
            /** @description a problem document, when failed */
            error: {
                [key: string]: unknown;
            } | null;
            links: {
                [key: string]: string;
            };
            id: string;
            name: string;
            changed: number;
            designs: number;
            tried: number;
            passed: number;
            best: number;
            complete: boolean;
            aims: components["schemas"]["Aim"][];
        };
        /** @description Deviations of one rollout from what the plan and the controller believe. */
        Disturbance: {
            /**
             * @description added to the true friction
             * @default 0
             */
            friction: number;
            /**
             * @description added to that, at the front wheels
             * @default 0
             */
            friction_front: number;
            /**
             * @description added to that, at the rear wheels
             * @default 0
             */
            friction_rear: number;
            /** @description the true friction of the wheels FL, FR, RL, RR instead */
            friction_wheels?: number[] | null;
            /**
             * @description share of the robot's mass, on the trunk
             * @default 0
             */
            mass: number;
            /**
             * @description on top of the trunk's middle [kg], or a mass and its place
             * @default 0
             */
            payload: number | components["schemas"]["AddedPayload"];
            /**
             * @description the robot's CoM moves forward [m]
             * @default 0
             */
            com_x: number;
            /**
             * @description the robot's CoM moves up [m]
             * @default 0
             */
            com_z: number;
            /**
             * @description added to the terrain's rise [m]
             * @default 0
             */
            height: number;
            /**
             * @description each rise or descent is off: standard deviation, or one after the other [m]
             * @default 0
             */
            step_height_error: number | number[];
            /**
             * @description each face is moved along: standard deviation, or one after the other [m]
             * @default 0
             */
            face_place_error: number | number[];
            /**
             * @description the robot starts turned to the left of the course [rad]
             * @default 0
             */
            heading: number;
            /**
             * @description the terrain rises to the left [rad]
             * @default 0
             */
            cross_slope: number;
            /**
             * @description the robot believes to start farther ahead than it does [m]
             * @default 0
             */
            x_offset: number;
            /**
             * @description share by which a way seems longer than it is
             * @default 0
             */
            odometry_scale: number;
            /**
             * @description added to the pitch: the IMU is mounted pitched [rad]
             * @default 0
             */
            pitch_bias: number;
            /**
             * @description sensor noise, in units of the sensors' own
             * @default 0
             */
            noise: number;
            /**
             * @description from sensing to torque [s]
             * @default 0
             */
            delay: number;
            /**
             * @description of the torques [Hz]; 0: they act at once
             * @default 0
             */
            bandwidth: number;
            /**
             * @description share by which motors give more than asked for
             * @default 0
             */
            torque_scale: number;
            /**
             * @description dry friction of each leg joint and wheel [Nm]
             * @default 0
             */
            stiction: number;
            /** @description of every motor, as its joint feels it [kg m^2] */
            rotor_inertia?: number | null;
            /**
             * @description what the robot's own inertial sensor errs by, where sensing is robot
             * @default {
             *       "gyro_bias": 0,
             *       "accelerometer_bias": 0
             *     }
             */
            imu: components["schemas"]["ImuErrors"];
        };
        /**
         * @description What to change in what is noted about a stored result; what is left out stays.
         * @example {
         *       "name": "before the fix",
         *       "pinned": true
         *     }
         */
        EntryChanges: {
            name?: string | null;
            note?: string | null;
            /** @description stays when room is made */
            pinned?: boolean | null;
        };
        /** @description A format of files. */
        ExportFormat: {
            name: string;
            /** @description what it is for, in a few words */
            note: string;
        };
        /** @description Level ground. */
        FlatParameters: {
            /** @constant */
            kind: "flat";
            /**
             * @description [m]
             * @default 4
             */
            length: number;
            /** @default flat */
            name: string;
            /**
             * @description Coulomb, wheel on terrain
             * @default 0.6
             */
            friction: number;
        };
        /** @description Feedback gains that suit this robot; the controller's settings may override them. */
        Gains: {
            /** @description thigh and calf [Nm/rad] */
            joint_stiffness: number;
            /** @description thigh and calf [Nm s/rad] */
            joint_damping: number;
            /** @description wheel rate feedback [Nm s/rad] */
            wheel_damping: number;
        };
        /** @description The service is ready. */
        Health: {
            /**
             * @default ok
             * @constant
             */
            status: "ok";
            version: string;
            /** @description why nothing is saved and what to do, if nothing is */
            read_only?: string | null;
        };
        /** @description Hip axes in the trunk frame: (x, z) of the front and the rear one, and the legs' y. */
        Hips: {
            front: number[];
            rear: number[];
            /** @description distance of the leg planes from the middle [m] */
            half_track: number;
        };
        /**
         * @description A robot that was read from a file.
         *
         *     `assumed` lists numbers that the file does not give, `warnings` what its reader should know.
         */
        Imported: {
            robot: components["schemas"]["Robot"];
            assumed: string[];
            warnings: string[];
            /** @description of the 12 joints, by our names */
            joints: {
                [key: string]: components["schemas"]["JointMap"];
            };
            /** @description the file's other joints, and where they are held [rad or m] */
            locked: {
                [key: string]: number;
            };
        };
        /**
         * @description Errors of the inertial sensor, beside those that the usual one has.
         *
         *     They matter where the controller's sensing is `robot`.
         */
        ImuErrors: {
            /**
             * @description about each axis [rad/s]
             * @default 0
             */
            gyro_bias: number;
            /**
             * @description along each axis [m/s^2]
             * @default 0
             */
            accelerometer_bias: number;
            /** @description of a reading; the usual one if empty [rad/s] */
            gyro_noise?: number | null;
            /** @description of a reading; the usual one if empty [m/s^2] */
            accelerometer_noise?: number | null;
        };
        /** @description A job's state. */
        JobDocument: {
            id: string;
            /** @enum {string} */
            kind: "rollout" | "trials" | "margins";
            /** @enum {string} */
            state: "queued" | "running" | "done" | "failed" | "cancelled";
            progress: number;
            /** @description seconds since 1970 */
            created: number;
            /** @description seconds until it is done, waiting included, as far as known */
            eta: number | null;
            /** @description where the result is, when done */
            result: string | null;
            /** @description a problem document, when failed */
            error: {
                [key: string]: unknown;
            } | null;
            links: {
                [key: string]: string;
            };
        };
        /** @description How the robot's own software counts a joint: theirs = sign * (ours - offset). */
        JointFrame: {
            /**
             * @description -1 where its axis points to the right
             * @default 1
             * @enum {integer}
             */
            sign: -1 | 1;
            /**
             * @description our angle where theirs is 0 [rad]
             * @default 0
             */
            offset: number;
        };
        /** @description How a joint of ours follows from one of the file's: ours = sign * theirs + offset. */
        JointMap: {
            /** @description in the file */
            name: string;
            /** @description +1 or -1: the file's axis against ours */
            sign: number;
            /** @description our angle where the file's joint is at 0 [rad] */
            offset: number;
        };
        /** @description Joint ranges of the front and the rear legs. */
        Joints: {
            front: components["schemas"]["LegLimits"];
            rear: components["schemas"]["LegLimits"];
        };
        /** @description Which way the knees bend in the plan of a robot whose knees bend both ways. */
        Knees: {
            /** @enum {string} */
            front: "back" | "forward";
            /** @enum {string} */
            rear: "back" | "forward";
        };
        /** @description Joint ranges of one leg pair [rad]. The sign of the calf's range says how the knee bends. */
        LegLimits: {
            thigh: number[];
            calf: number[];
        };
        /** @description The quantity that is missing: what would be needed, and what there is. */
        Limit: {
            needed: number;
            available: number;
            /** @default  */
            quantity: string;
            /** @default  */
            unit: string;
            /**
             * @description values of what else must change with it
             * @default {}
             */
            given: {
                [key: string]: number;
            };
            /** @description values asked of all of planning: with the first there is no plan, with the second there is one, with everything else as it is */
            confirmed?: number[] | null;
        };
        /**
         * @description A thigh or a calf: its frame sits in its upper joint; at angle 0 the lower one is below it.
         *
         *     A bent shank is one whose capsules leave that line.
         */
        Link: {
            /** @description from joint to joint [m] */
            length: number;
            /** @description of the capsule [m] */
            radius: number;
            /** @description [kg] */
            mass: number;
            /** @description mass centre: a fraction of the length, or (x, z) in the link's frame [m] */
            com: number | number[];
            /** @description Ixx, Iyy, Izz about the mass centre [kg m^2] */
            inertia: number[];
            /**
             * @description capsules; one from joint to joint if empty
             * @default []
             */
            shape: components["schemas"]["LinkShape"][];
        };
        /** @description A capsule of a link that is not one straight capsule from joint to joint. */
        LinkShape: {
            /** @description (x, z) in the link's frame [m] */
            start: number[];
            /** @description (x, z) in the link's frame [m] */
            end: number[];
            /** @description [m] */
            radius: number;
        };
        /** @description How far a pose is from failing. More is better; negative is violated. */
        Margins: {
            /** @description least distance of trunk and links from the terrain [m] */
            clearance: number;
            /** @description CoM shift in x, the smaller way, that keeps equilibrium [m] */
            com: number;
            /** @description friction there is minus friction needed */
            friction: number;
            /** @description limit minus the largest static joint torque [Nm] */
            torque: number;
        };
        /** @description The highest surface at each place of a grid (``stairwright/mesh-heights/1``). Metres. */
        MeshHeights: {
            /** @default stairwright/mesh-heights/1 */
            schema: string;
            /** @description of the file */
            triangles: number;
            /** @description least x, y, z [m] */
            low: number[];
            /** @description most x, y, z [m] */
            high: number[];
            /** @description rows from least to most y, columns from least to most x: height in the middle of each cell [m]; null where there is no surface */
            heights: (number | null)[][];
        };
        /** @description Figures of one rollout; angles in rad. */
        Metrics: {
            /** @description simulated time until the end [s] */
            duration: number;
            /** @description [rad] */
            pitch_error_max: number;
            /** @description [rad] */
            pitch_error_rms: number;
            /** @description thighs and calves [rad] */
            joint_error_rms: number;
            /** @description thighs and calves [Nm] */
            torque_peak: number;
            /** @description [Nm] */
            wheel_torque_peak: number;
            /** @description largest root mean square of a thigh's or calf's torque [Nm] */
            torque_rms?: number | null;
            /** @description largest root mean square of a motor's torque as a share of its `continuous` torque: above 1 it gets too hot in time; null where the robot's file has none */
            continuous_share?: number | null;
            /** @description integral of |torque x speed| over all joints [J] */
            energy: number;
            /** @description control steps in which trunk or a link touched the terrain */
            link_contacts: number;
            /** @description largest such force, averaged over 20 ms [N] */
            link_force_peak: number;
            /** @description control steps in which legs touched each other */
            self_contacts: number;
            /** @description largest distance of a wheel from the plan's end [m] */
            end_error: number;
            /** @description share of the plan that was reached, 0..1 */
            progress: number;
            /** @description along the course [m/s] */
            speed_mean: number;
            /** @description along the course, from the first contact with the first face to all wheels on the landing [m/s]; null where the ground is level or the robot does not get there */
            speed_stairs?: number | null;
            /** @description energy per weight and way; null where it does not get on */
            cost_of_transport?: number | null;
            /** @description simulated time per wall-clock time */
            real_time_factor: number;
        };
        /** @description A convex piece of the trunk, seen from the side and extruded along y. */
        Outline: {
            /** @description convex, (x, z) in the trunk frame [m] */
            points: number[][];
            /** @description along y [m] */
            width: number;
        };
        /** @description A load that is fixed to the trunk. */
        Payload: {
            /** @description [kg] */
            mass: number;
            /**
             * @description (x, z) in the trunk frame [m]
             * @default [
             *       0,
             *       0
             *     ]
             */
            place: number[];
        };
        /** @description A plan (``stairwright/plan/1``); `id` is a hash of everything that went into it. */
        Plan: {
            /**
             * @default stairwright/plan/1
             * @constant
             */
            schema: "stairwright/plan/1";
            id: string;
            /** @enum {string} */
            method: "path" | "critical" | "nominal";
            terrain: components["schemas"]["Terrain"];
            terrain_hash: string;
            robot: string;
            robot_hash: string;
            robot_description: components["schemas"]["Robot"];
            friction: number;
            /** @default {} */
            weights: {
                [key: string]: number;
            };
            /** @enum {string} */
            status: "feasible" | "infeasible";
            problem?: components["schemas"]["Problem"] | null;
            /** @default [] */
            poses: components["schemas"]["Pose"][];
            /**
             * @description indices of the key poses
             * @default []
             */
            critical: number[];
            timing: components["schemas"]["Timing"];
            /** @description [s] */
            solve_time: number;
            certificate?: components["schemas"]["Certificate"] | null;
            /** @description where the robot's knees bend both ways */
            knees?: components["schemas"]["Knees"] | null;
            /**
             * @description backward: the robot's rear leads, and `robot_description` and all poses are of the robot turned about, whose front legs are the rear ones of `robot`
             * @default forward
             * @enum {string}
             */
            facing: "forward" | "backward";
            /** @description where the CoM's margin or the clearance is thin and the plan with the robot's other end in front leaves clearly more: that end, and its margins */
            safer_facing?: components["schemas"]["SaferFacing"] | null;
            /** @description which margin is least */
            binding?: components["schemas"]["Binding"] | null;
            /** @description of a dense feasible plan: sum of |static torque x turn| over all joints and poses, without dynamics, friction and losses [J] */
            energy?: number | null;
            /** @description that energy per weight and way; null where there is none */
            cost_of_transport?: number | null;
            /** @description how far the world may be from what was drawn, where that was asked for; margins are then those at the lowest friction */
            tolerance?: components["schemas"]["Tolerance"] | null;
        };
        /**
         * @description A question to the planner.
         * @example {
         *       "method": "path",
         *       "robot": "a1_wheeled",
         *       "terrain": "single-stair-036"
         *     }
         * @example {
         *       "friction": 0.8,
         *       "method": "critical",
         *       "terrain": {
         *         "points": [
         *           [
         *             -1.5,
         *             0
         *           ],
         *           [
         *             0,
         *             0
         *           ],
         *           [
         *             0,
         *             0.2
         *           ],
         *           [
         *             2,
         *             0.2
         *           ]
         *         ]
         *       },
         *       "weights": {
         *         "com_x": 50
         *       }
         *     }
         */
        PlanRequest: {
            /** @description a terrain's name, a terrain document, or a kind with its measures */
            terrain: string | components["schemas"]["StairParameters"] | components["schemas"]["RampParameters"] | components["schemas"]["FlatParameters"] | components["schemas"]["Terrain"];
            /**
             * @description a robot's name or a robot document
             * @default a1_wheeled
             */
            robot: string | components["schemas"]["Robot"];
            /** @description the terrain's own by default */
            friction?: number | null;
            /**
             * @default path
             * @enum {string}
             */
            method: "path" | "critical" | "nominal";
            /** @description cost weights by name, see GET /settings */
            weights?: {
                [key: string]: boolean | number;
            } | null;
            /**
             * @description fast: a path as fast as friction, torques and speeds allow, see `aggressiveness`
             * @default steady
             * @enum {string}
             */
            timing: "steady" | "fast";
            /** @description which end of the robot leads, see `facing` of a plan; either: as the planner finds better, which is the default where `timing` is fast, else forward */
            facing?: ("forward" | "backward" | "either") | null;
            /** @description how far the world may be from what is drawn, with the certificate holding for all of it; of the method `path` */
            tolerance?: components["schemas"]["Tolerance"] | null;
        };
        /** @description The scene's clock; what is left out stays. */
        PlaybackRequest: {
            /** @description [s] */
            time?: number | null;
            /** @description [m] along the course */
            progress?: number | null;
            playing?: boolean | null;
            /** @description factor on real time */
            speed?: number | null;
        };
        /** @description One pose of the robot in the x-z plane; world frame, SI units. */
        Pose: {
            /** @description way since the start, strictly rising, about the wheels' mean arc length [m] */
            progress: number;
            /**
             * @description planned time since the start [s]
             * @default 0
             */
            time: number;
            /** @description trunk point [m] */
            x_c: number;
            /** @description trunk point [m] */
            z_c: number;
            /** @description about +y: nose-up is negative [rad] */
            pitch: number;
            /** @description front thigh, front calf, rear thigh, rear calf [rad] */
            q: number[];
            /** @description wheel centres, front and rear [m] */
            wheels: number[][];
            /** @description arc length along the wheel-centre curve [m] */
            wheel_progress: number[];
            /** @description contact points, front and rear [m] */
            contacts: number[][];
            /** @description centre of mass of the whole robot [m] */
            com: number[];
            /** @description trunk, front leg, rear leg [m] */
            collision_points: number[][];
            /** @description static (tangential, normal) force of each wheel pair [N] */
            forces?: number[][] | null;
            margins: components["schemas"]["Margins"];
        };
        /** @description What stops the robot, where, and by how much. */
        Problem: {
            /** @enum {string} */
            kind: "reach" | "clearance" | "statics" | "torque" | "joint_limit" | "start" | "goal";
            /** @description place on the terrain [m] */
            at: number[];
            /** @description how far the plan gets [m] */
            progress: number;
            message: string;
            limit?: components["schemas"]["Limit"] | null;
            /** @description the `facing` that has a plan, where the one asked for has none */
            feasible_facing?: ("forward" | "backward") | null;
        };
        /** @description One inclined plane. */
        RampParameters: {
            /**
             * @description level ground before it [m]
             * @default 1.5
             */
            approach: number;
            /**
             * @description level ground on top and after it [m]
             * @default 2
             */
            platform: number;
            /**
             * @default up
             * @enum {string}
             */
            direction: "up" | "down" | "up-down";
            /** @description made from the measures by default */
            name?: string | null;
            /**
             * @description Coulomb, wheel on terrain
             * @default 0.6
             */
            friction: number;
            /** @constant */
            kind: "ramp";
            /** @description height gained [m] */
            rise: number;
            /** @description from the horizontal [rad] */
            slope: number;
        };
        /** @description Ranges (low, high) from which each trial draws its deviations; see `Disturbance`. */
        Ranges: {
            /**
             * @description added to the true friction
             * @default [
             *       -0.1,
             *       0.1
             *     ]
             */
            friction: number[];
            /**
             * @description share of the robot's mass, on the trunk
             * @default [
             *       -0.1,
             *       0.1
             *     ]
             */
            mass: number[];
            /**
             * @description CoM forward [m]
             * @default [
             *       -0.02,
             *       0.02
             *     ]
             */
            com_x: number[];
            /**
             * @description CoM up [m]
             * @default [
             *       -0.02,
             *       0.02
             *     ]
             */
            com_z: number[];
            /**
             * @description added to the terrain's rise [m]
             * @default [
             *       -0.01,
             *       0.01
             *     ]
             */
            height: number[];
            /**
             * @description sensor noise, in units of the sensors' own
             * @default [
             *       1,
             *       1
             *     ]
             */
            noise: number[];
            /**
             * @description from sensing to torque [s]
             * @default [
             *       0.004,
             *       0.004
             *     ]
             */
            delay: number[];
            /**
             * @description added to that, at the front wheels
             * @default [
             *       0,
             *       0
             *     ]
             */
            friction_front: number[];
            /**
             * @description added to that, at the rear wheels
             * @default [
             *       0,
             *       0
             *     ]
             */
            friction_rear: number[];
            /**
             * @description on top of the trunk's middle [kg]
             * @default [
             *       0,
             *       0
             *     ]
             */
            payload: number[];
            /**
             * @description of each rise or descent, standard deviation [m]
             * @default [
             *       0,
             *       0
             *     ]
             */
            step_height_error: number[];
            /**
             * @description of each face's place, standard deviation [m]
             * @default [
             *       0,
             *       0
             *     ]
             */
            face_place_error: number[];
            /**
             * @description the robot starts turned to the left of the course [rad]
             * @default [
             *       0,
             *       0
             *     ]
             */
            heading: number[];
            /**
             * @description the terrain rises to the left [rad]
             * @default [
             *       0,
             *       0
             *     ]
             */
            cross_slope: number[];
            /**
             * @description the robot believes to start farther ahead than it does [m]
             * @default [
             *       0,
             *       0
             *     ]
             */
            x_offset: number[];
            /**
             * @description share by which a way seems longer than it is
             * @default [
             *       0,
             *       0
             *     ]
             */
            odometry_scale: number[];
            /**
             * @description the IMU is mounted pitched [rad]
             * @default [
             *       0,
             *       0
             *     ]
             */
            pitch_bias: number[];
            /**
             * @description of the torques [Hz]; 0: they act at once
             * @default [
             *       0,
             *       0
             *     ]
             */
            bandwidth: number[];
            /**
             * @description share by which motors give more than asked for
             * @default [
             *       0,
             *       0
             *     ]
             */
            torque_scale: number[];
            /**
             * @description dry friction of each leg joint and wheel [Nm]
             * @default [
             *       0,
             *       0
             *     ]
             */
            stiction: number[];
        };
        /** @description What the rear legs have unlike the front ones. */
        RearLegs: {
            thigh?: components["schemas"]["Link"] | null;
            calf?: components["schemas"]["Link"] | null;
            wheel?: components["schemas"]["Wheel"] | null;
            actuators?: components["schemas"]["Actuators"] | null;
        };
        /** @description A wheel-legged robot (``stairwright/robot/2``; ``/1`` has fewer fields, see `_NEW_IN_2`). */
        Robot: {
            /**
             * @default stairwright/robot/2
             * @enum {string}
             */
            schema: "stairwright/robot/1" | "stairwright/robot/2";
            name: string;
            /** @default  */
            description: string;
            /**
             * @description where the numbers are from
             * @default
             */
            source: string;
            /**
             * @description numbers that nobody publishes, and what was taken
             * @default []
             */
            assumed: string[];
            /**
             * @description which sentence of `assumed`, from 0, tells a field, by its path: wheel.radius, rear.actuators.calf.torque
             * @default {}
             */
            assumed_fields: {
                [key: string]: number;
            };
            /** @description trunk centre above the ground, standing [m] */
            nominal_height: number;
            trunk: components["schemas"]["Trunk"];
            payload?: components["schemas"]["Payload"] | null;
            hips: components["schemas"]["Hips"];
            thigh: components["schemas"]["Link"];
            calf: components["schemas"]["Link"];
            wheel: components["schemas"]["Wheel"];
            /** @description where the rear legs differ */
            rear?: components["schemas"]["RearLegs"] | null;
            joints: components["schemas"]["Joints"];
            /**
             * @description angle at which the abduction joints are locked [rad]
             * @default 0
             */
            abduction: number;
            actuators: components["schemas"]["Actuators"];
            /** @description from masses and motors if empty */
            gains?: components["schemas"]["Gains"] | null;
            /** @description 25 and more if empty */
            collision_points?: components["schemas"]["CollisionPoints"] | null;
            /**
             * @description what the robot's own software calls its joints, by our names (FL_thigh ... RR_wheel); used in ROS messages and URDF
             * @default {}
             */
            joint_names: {
                [key: string]: string;
            };
            /**
             * @description how the robot's own software counts the angles of its joints, by our names; used in ROS messages and URDF
             * @default {}
             */
            joint_frames: {
                [key: string]: components["schemas"]["JointFrame"];
            };
            /**
             * @description joints of the file it was imported from that count as rigid, by the file's names, and where they are held [rad or m]
             * @default {}
             */
            held_joints: {
                [key: string]: number;
            };
        };
        /** @description A robot, whether it is one of the read-only presets, and which version of it this is. */
        RobotDocument: {
            /**
             * @default stairwright/robot/2
             * @enum {string}
             */
            schema: "stairwright/robot/1" | "stairwright/robot/2";
            name: string;
            /** @default  */
            description: string;
            /**
             * @description where the numbers are from
             * @default
             */
            source: string;
            /**
             * @description numbers that nobody publishes, and what was taken
             * @default []
             */
            assumed: string[];
            /**
             * @description which sentence of `assumed`, from 0, tells a field, by its path: wheel.radius, rear.actuators.calf.torque
             * @default {}
             */
            assumed_fields: {
                [key: string]: number;
            };
            /** @description trunk centre above the ground, standing [m] */
            nominal_height: number;
            trunk: components["schemas"]["Trunk"];
            payload?: components["schemas"]["Payload"] | null;
            hips: components["schemas"]["Hips"];
            thigh: components["schemas"]["Link"];
            calf: components["schemas"]["Link"];
            wheel: components["schemas"]["Wheel"];
            /** @description where the rear legs differ */
            rear?: components["schemas"]["RearLegs"] | null;
            joints: components["schemas"]["Joints"];
            /**
             * @description angle at which the abduction joints are locked [rad]
             * @default 0
             */
            abduction: number;
            actuators: components["schemas"]["Actuators"];
            /** @description from masses and motors if empty */
            gains?: components["schemas"]["Gains"] | null;
            /** @description 25 and more if empty */
            collision_points?: components["schemas"]["CollisionPoints"] | null;
            /**
             * @description what the robot's own software calls its joints, by our names (FL_thigh ... RR_wheel); used in ROS messages and URDF
             * @default {}
             */
            joint_names: {
                [key: string]: string;
            };
            /**
             * @description how the robot's own software counts the angles of its joints, by our names; used in ROS messages and URDF
             * @default {}
             */
            joint_frames: {
                [key: string]: components["schemas"]["JointFrame"];
            };
            /**
             * @description joints of the file it was imported from that count as rigid, by the file's names, and where they are held [rad or m]
             * @default {}
             */
            held_joints: {
                [key: string]: number;
            };
            /** @description a preset; it cannot be changed or deleted */
            readonly: boolean;
            /** @description hash of its content, as in plans' `robot_hash` */
            version: string;
        };
        /** @description What a plan stands in simulation (``stairwright/margins/1``). */
        RobustMargins: {
            /**
             * @default stairwright/margins/1
             * @constant
             */
            schema: "stairwright/margins/1";
            /** @description hash of the question */
            id: string;
            plan_id: string;
            terrain_hash: string;
            robot_hash: string;
            controller: components["schemas"]["ControllerSettings"];
            seed: number;
            /** @description of the loop, up to which it succeeds; none if not even without [s] */
            delay: number | null;
            /** @description less than planned, up to which it succeeds */
            friction: number | null;
            /** @description what happens beyond; empty if nothing was tried there */
            delay_ends: string;
            /** @description what happens beyond; empty if nothing was tried there */
            friction_ends: string;
        };
        /** @description A rollout (``stairwright/rollout/1``); `id` is a hash of everything that went into it. */
        Rollout: {
            /**
             * @default stairwright/rollout/1
             * @constant
             */
            schema: "stairwright/rollout/1";
            id: string;
            plan_id: string;
            method: string;
            terrain: components["schemas"]["Terrain"];
            terrain_hash: string;
            robot: string;
            robot_hash: string;
            robot_description: components["schemas"]["Robot"];
            /**
             * @description the file whose model was simulated, if not ours
             * @default
             */
            model: string;
            friction: number;
            seed: number;
            controller: components["schemas"]["ControllerSettings"];
            /**
             * @description what deviated, see Disturbance
             * @default {}
             */
            disturbance: {
                [key: string]: unknown;
            };
            /** @enum {string} */
            outcome: "success" | "fell" | "stuck" | "collided" | "diverged" | "timeout" | "stopped";
            /** @description one sentence: what happened, where and when */
            reason: string;
            metrics: components["schemas"]["Metrics"];
            series: components["schemas"]["Series"];
            /** @description the plan that was carried out */
            plan?: components["schemas"]["Plan"] | null;
        };
        /**
         * @description A question to the simulator.
         * @example {
         *       "robot": "a1_wheeled_x",
         *       "seed": 1,
         *       "terrain": "single-stair-030"
         *     }
         * @example {
         *       "friction": 0.5,
         *       "plan_id": "p-0123456789abcdef"
         *     }
         */
        RolloutRequest: {
            /** @description a plan that POST /plans answered with */
            plan_id?: string | null;
            /** @description a whole plan document */
            plan?: components["schemas"]["Plan"] | null;
            /** @description what to plan over first */
            terrain?: (string | components["schemas"]["StairParameters"] | components["schemas"]["RampParameters"] | components["schemas"]["FlatParameters"] | components["schemas"]["Terrain"]) | null;
            /**
             * @description with `terrain`
             * @default a1_wheeled
             */
            robot: string | components["schemas"]["Robot"];
            /**
             * @description with `terrain`
             * @default path
             * @enum {string}
             */
            method: "path" | "critical" | "nominal";
            /** @description with `terrain` */
            weights?: {
                [key: string]: boolean | number;
            } | null;
            /**
             * @description with `terrain`
             * @default steady
             * @enum {string}
             */
            timing: "steady" | "fast";
            /** @description with `terrain` */
            facing?: ("forward" | "backward" | "either") | null;
            /** @description with `terrain` */
            tolerance?: components["schemas"]["Tolerance"] | null;
            /** @description friction in the simulation (and of the plan, with `terrain`) */
            friction?: number | null;
            /** @description controller settings by name, see GET /settings */
            controller?: {
                [key: string]: boolean | string | (number | null);
            } | null;
            /** @default 0 */
            seed: number;
            /** @description how the real world differs from what plan and controller believe */
            disturbance?: components["schemas"]["Disturbance"] | null;
        };
        /** @description Which end in front leaves clearly more of a thin margin, and the least of that plan. */
        SaferFacing: {
            /** @enum {string} */
            facing: "forward" | "backward";
            /**
             * @description the margin that is thin here
             * @default com
             * @enum {string}
             */
            by: "com" | "clearance";
            /** @description [m] */
            com_margin: number;
            /** @description from the robot to the terrain [m] */
            clearance?: number | null;
        };
        /** @description What the scene shows; what is left out stays, null shows none. */
        SceneRequest: {
            plan_id?: string | null;
            rollout_id?: string | null;
            /** @description a second plan, whose robot is shown translucent at the same place */
            compare_plan_id?: string | null;
            theme?: ("dark" | "light") | null;
            layers?: {
                [key: string]: boolean;
            } | null;
            camera?: ("side" | "iso" | "front" | "follow") | null;
        };
        /**
         * @description Samples at even times (N of them). SI units, world frame; numpy arrays, lists in JSON.
         *
         *     Joint order is the contract's: FL, FR, RL, RR, each thigh, calf, wheel.
         */
        Series: {
            /** @description [N] s */
            time: number[];
            /** @description [N, 3] trunk point [m] */
            base_position: number[][];
            /** @description [N, 4] trunk, wxyz */
            base_quaternion: number[][];
            /** @description [N, 12] joint angles [rad] */
            q: number[][];
            /** @description [N, 12] what the plan asks for [rad]; wheels: the angle rolled so far */
            q_desired: number[][];
            /** @description [N, 12] joint speeds [rad/s] */
            dq: number[][];
            /** @description [N, 12] joint torques after all limits [Nm] */
            torque: number[][];
            /** @description [N] about +y: nose-up is negative [rad] */
            pitch: number[];
            /** @description [N] rad */
            pitch_desired: number[];
            /** @description [N] measured, mean of the wheels since the start [m] */
            progress: number[];
            /** @description [N] the plan's, held back by the maximum lead [m] */
            progress_desired: number[];
            /** @description [N, 4, 2] force of the terrain on each wheel, world x and z [N] */
            contact_force: number[][][];
        };
        /** @description A 3D scene of one browser session. */
        SessionDocument: {
            id: string;
            /** @description path of the scene's page */
            scene: string;
        };
        /** @description JSON Schemas of everything that can be tuned; each property has bounds, unit and scale. */
        SettingsDocument: {
            weights: {
                [key: string]: {
                    [key: string]: unknown;
                };
            };
            tolerance: {
                [key: string]: unknown;
            };
            controller: {
                [key: string]: unknown;
            };
            disturbance: {
                [key: string]: unknown;
            };
            /** @description deviations that trials draw from, by name */
            bundles: {
                [key: string]: components["schemas"]["Ranges"];
            };
            exports: {
                [key: string]: components["schemas"]["ExportFormat"][];
            };
        };
        /** @description A plan by its id or in full, or what to plan first; and how to carry it out. */
        Simulation: {
            /** @description a plan that POST /plans answered with */
            plan_id?: string | null;
            /** @description a whole plan document */
            plan?: components["schemas"]["Plan"] | null;
            /** @description what to plan over first */
            terrain?: (string | components["schemas"]["StairParameters"] | components["schemas"]["RampParameters"] | components["schemas"]["FlatParameters"] | components["schemas"]["Terrain"]) | null;
            /**
             * @description with `terrain`
             * @default a1_wheeled
             */
            robot: string | components["schemas"]["Robot"];
            /**
             * @description with `terrain`
             * @default path
             * @enum {string}
             */
            method: "path" | "critical" | "nominal";
            /** @description with `terrain` */
            weights?: {
                [key: string]: boolean | number;
            } | null;
            /**
             * @description with `terrain`
             * @default steady
             * @enum {string}
             */
            timing: "steady" | "fast";
            /** @description with `terrain` */
            facing?: ("forward" | "backward" | "either") | null;
            /** @description with `terrain` */
            tolerance?: components["schemas"]["Tolerance"] | null;
            /** @description friction in the simulation (and of the plan, with `terrain`) */
            friction?: number | null;
            /** @description controller settings by name, see GET /settings */
            controller?: {
                [key: string]: boolean | string | (number | null);
            } | null;
            /** @default 0 */
            seed: number;
        };
        /** @description A flight of equal steps. */
        StairParameters: {
            /**
             * @description level ground before it [m]
             * @default 1.5
             */
            approach: number;
            /**
             * @description level ground on top and after it [m]
             * @default 2
             */
            platform: number;
            /**
             * @default up
             * @enum {string}
             */
            direction: "up" | "down" | "up-down";
            /** @description made from the measures by default */
            name?: string | null;
            /**
             * @description Coulomb, wheel on terrain
             * @default 0.6
             */
            friction: number;
            /** @constant */
            kind: "stair";
            /** @description height of a step [m] */
            rise: number;
            /**
             * @description from edge to edge [m]
             * @default 0.3
             */
            run: number;
            /**
             * @description of steps
             * @default 1
             */
            count: number;
            /**
             * @description of the faces from the horizontal [rad]
             * @default 1.5707963267948966
             */
            face_angle: number;
        };
        /** @description A stored plan, rollout or set of trials in a list. */
        StoredEntry: {
            id: string;
            /** @description SHA-256 of its JSON */
            digest: string;
            /** @description seconds since 1970 */
            created: number;
            /** @description the user's own; empty if there is none */
            name: string;
            /** @description the user's own */
            note: string;
            /** @description stays when room is made for newer results */
            pinned: boolean;
            /** @description what it was asked, as far as that differs from the defaults, and its figures */
            summary: {
                [key: string]: unknown;
            };
        };
        /** @description A study (``stairwright/study/1``): every combination of the axes' values is a cell. */
        Study: {
            /**
             * @default stairwright/study/1
             * @constant
             */
            schema: "stairwright/study/1";
            /** @default  */
            name: string;
            /** @default  */
            description: string;
            /** @description a name, a document, or a kind with measures; by the axes if empty */
            terrain?: (string | components["schemas"]["StairParameters"] | components["schemas"]["RampParameters"] | components["schemas"]["FlatParameters"] | components["schemas"]["Terrain"]) | null;
            /** @default a1_wheeled */
            robot: string | components["schemas"]["Robot"];
            /**
             * @description documents of the robots that an axis `robot` names
             * @default {}
             */
            robots: {
                [key: string]: components["schemas"]["Robot"];
            };
            /** @description the terrain's own by default */
            friction?: number | null;
            /**
             * @default path
             * @enum {string}
             */
            method: "path" | "critical" | "nominal";
            /** @default {} */
            weights: {
                [key: string]: boolean | number;
            };
            /**
             * @description of plans of the method path, as for a plan
             * @default steady
             * @enum {string}
             */
            timing: "steady" | "fast";
            /** @description which end of the robot leads, as for a plan */
            facing?: ("forward" | "backward" | "either") | null;
            /** @description that plans of the method path shall stand; axes may vary it */
            tolerance?: components["schemas"]["Tolerance"] | null;
            axes: components["schemas"]["Axis"][];
            /**
             * @default plan
             * @enum {string}
             */
            compute: "plan" | "rollout" | "trials";
            /**
             * @description of which cells without a way is found out what would open it, which takes most of their time: all, those at the last value of the boundary axis, or none
             * @default all
             * @enum {string}
             */
            diagnose: "all" | "last" | "none";
            /**
             * @description of rollouts and trials
             * @default {}
             */
            controller: {
                [key: string]: unknown;
            };
            /** @default 0 */
            seed: number;
            /**
             * @default {
             *       "count": 29
             *     }
             */
            trials: components["schemas"]["TrialSettings"];
        };
        /** @description A study's state. Events leave the axes out. */
        StudyDocument: {
            id: string;
            name: string;
            /** @enum {string} */
            state: "queued" | "running" | "done" | "failed" | "cancelled";
            /** @description cells that are known */
            done: number;
            /** @description cells that are to be known, as far as can be told */
            total: number;
            progress: number;
            /** @description seconds until it is done, by its own pace so far */
            eta: number | null;
            /** @description what is done before its first cells; empty from then on */
            stage: string;
            /** @description seconds since 1970 */
            created: number;
            /** @description by another version of the planner than this service's */
            outdated: boolean;
            /** @description a problem document, when failed */
            error: {
                [key: string]: unknown;
            } | null;
            axes: components["schemas"]["AxisDocument"][];
            /** @enum {string} */
            compute: "plan" | "rollout" | "trials";
            links: {
                [key: string]: string;
            };
        };
        /**
         * @description A profile and its friction (``stairwright/terrain/1``). Metres, world frame.
         *
         *     `x` never decreases along `points`; equal `x` is a vertical face. `start` and `goal` are the
         *     trunk's x at both ends; without them the robot starts on the first flat stretch and ends on
         *     the last one.
         */
        Terrain: {
            /**
             * @default stairwright/terrain/1
             * @constant
             */
            schema: "stairwright/terrain/1";
            /** @default unnamed */
            name: string;
            /** @default  */
            description: string;
            points: number[][];
            /**
             * @description Coulomb friction, wheel on terrain
             * @default 0.6
             */
            friction: number;
            /** @description x of the trunk at the start [m] */
            start?: number | null;
            /** @description x of the trunk at the goal [m] */
            goal?: number | null;
        };
        /** @description A terrain, and whether it is one of the read-only presets. */
        TerrainDocument: {
            /**
             * @default stairwright/terrain/1
             * @constant
             */
            schema: "stairwright/terrain/1";
            /** @default unnamed */
            name: string;
            /** @default  */
            description: string;
            points: number[][];
            /**
             * @description Coulomb friction, wheel on terrain
             * @default 0.6
             */
            friction: number;
            /** @description x of the trunk at the start [m] */
            start?: number | null;
            /** @description x of the trunk at the goal [m] */
            goal?: number | null;
            /** @description a preset; it cannot be changed or deleted */
            readonly: boolean;
        };
        /** @description Planned duration, and the time of every pose. */
        Timing: {
            /** @description [s] */
            total: number;
            /**
             * @description limits: steady, within limits of speed; paper: eqs 25-26; fast: time-optimal under dynamic limits
             * @default limits
             * @enum {string}
             */
            rule: "limits" | "paper" | "fast";
            /** @description of a fast plan: at each pose what keeps it from being faster there */
            limits?: string[] | null;
        };
        /**
         * @description What a plan shall stand; docs/method.md says what the certificate makes of it.
         *
         *     Faces are stretches steeper than 45 degrees, treads what lies between them; both keep their
         *     slopes. The robot adapts as it does with its own sensors: the trunk keeps its pitch, its place
         *     follows the ground under the wheels by the load they carry, and the legs reach for the ground.
         */
        Tolerance: {
            /**
             * @description each step is up to this much taller or lower than drawn [m]
             * @default 0
             */
            height: number;
            /**
             * @description each face is up to this much nearer or farther than drawn [m]
             * @default 0
             */
            place: number;
            /**
             * @description friction is up to this much lower than planned
             * @default 0
             */
            friction: number;
        };
        /** @description One rollout of the set. */
        Trial: {
            seed: number;
            disturbance: components["schemas"]["Disturbance"];
            /** @enum {string} */
            outcome: "success" | "fell" | "stuck" | "collided" | "diverged" | "timeout" | "stopped";
            reason: string;
            pitch_error_max: number;
            link_contacts: number;
        };
        /** @description How many randomised rollouts a cell has, and what they draw from. */
        TrialSettings: {
            /**
             * @description 29 of 29: more than 90 % with 95 %
             * @default 29
             */
            count: number;
            /** @description of the deviations, see `sw.trials` */
            ranges?: components["schemas"]["Ranges"] | null;
        };
        /** @description A set of randomised rollouts (``stairwright/trials/1``). */
        Trials: {
            /**
             * @default stairwright/trials/1
             * @constant
             */
            schema: "stairwright/trials/1";
            /** @description hash of the question */
            id: string;
            plan_id: string;
            terrain_hash: string;
            robot_hash: string;
            /** @description nominal true friction; each trial adds its own */
            friction: number;
            seed: number;
            controller: components["schemas"]["ControllerSettings"];
            ranges: components["schemas"]["Ranges"];
            count: number;
            successes: number;
            /** @description share of successes */
            rate: number;
            /** @description 95 % confidence interval of the rate */
            wilson: number[];
            /** @description 95 % interval, exact */
            clopper_pearson: number[];
            outcomes: {
                [key: string]: number;
            };
            /**
             * @description deviations that are larger where trials failed: how often a failed one had more of it than one that succeeded
             * @default {}
             */
            suspects: {
                [key: string]: number;
            };
            trials: components["schemas"]["Trial"][];
        };
        /**
         * @description The same question many times over, under random deviations.
         * @example {
         *       "bundle": "laboratory",
         *       "count": 29,
         *       "terrain": "single-stair-030"
         *     }
         */
        TrialsRequest: {
            /** @description a plan that POST /plans answered with */
            plan_id?: string | null;
            /** @description a whole plan document */
            plan?: components["schemas"]["Plan"] | null;
            /** @description what to plan over first */
            terrain?: (string | components["schemas"]["StairParameters"] | components["schemas"]["RampParameters"] | components["schemas"]["FlatParameters"] | components["schemas"]["Terrain"]) | null;
            /**
             * @description with `terrain`
             * @default a1_wheeled
             */
            robot: string | components["schemas"]["Robot"];
            /**
             * @description with `terrain`
             * @default path
             * @enum {string}
             */
            method: "path" | "critical" | "nominal";
            /** @description with `terrain` */
            weights?: {
                [key: string]: boolean | number;
            } | null;
            /**
             * @description with `terrain`
             * @default steady
             * @enum {string}
             */
            timing: "steady" | "fast";
            /** @description with `terrain` */
            facing?: ("forward" | "backward" | "either") | null;
            /** @description with `terrain` */
            tolerance?: components["schemas"]["Tolerance"] | null;
            /** @description friction in the simulation (and of the plan, with `terrain`) */
            friction?: number | null;
            /** @description controller settings by name, see GET /settings */
            controller?: {
                [key: string]: boolean | string | (number | null);
            } | null;
            /** @default 0 */
            seed: number;
            /**
             * @description number of rollouts
             * @default 29
             */
            count: number;
            /** @description of deviations, see GET /settings */
            bundle?: string | null;
            /** @description deviations in full, instead of a bundle */
            ranges?: components["schemas"]["Ranges"] | null;
        };
        /** @description The body box; its centre is the trunk point (x_c, z_c). */
        Trunk: {
            /** @description length, width, height [m] */
            size: number[];
            /** @description [kg] */
            mass: number;
            /** @description Ixx, Iyy, Izz about the mass centre [kg m^2] */
            inertia: number[];
            /**
             * @description mass centre from the trunk point [m]
             * @default [
             *       0,
             *       0,
             *       0
             *     ]
             */
            com: number[];
            /**
             * @description what may touch the terrain; the box if empty
             * @default []
             */
            outline: components["schemas"]["Outline"][];
        };
        /** @description A number of the robot's file, and its bounds. */
        Vary: {
            /** @description such as robot.calf.length or payload */
            name: string;
            /** @description least and most */
            between: number[];
            /**
             * @description try ratios evenly instead of differences
             * @default false
             */
            log: boolean;
        };
        /** @description A wheel at the end of each calf. */
        Wheel: {
            /** @description [m] */
            radius: number;
            /** @description [m] */
            width: number;
            /** @description [kg] */
            mass: number;
            /** @description Ixx, Iyy, Izz about the centre [kg m^2] */
            inertia: number[];
            /** @description most that the tyre gives on any terrain */
            friction?: number | null;
            /**
             * @description share of the load that opposes rolling
             * @default 0
             */
            rolling_resistance: number;
        };
        /** @description One bad value. */
        FieldError: {
            /** @description path to the value, e.g. terrain.points.3 */
            field: string;
            /** @description what is wrong with it */
            message: string;
        };
        /** @description RFC 9457: what went wrong. */
        ProblemDocument: {
            /**
             * @description names the kind of problem; about:blank means no more than its status
             * @example about:blank
             */
            type: string;
            /** @example Unprocessable Content */
            title: string;
            /** @example 422 */
            status: number;
            /** @example terrain.points.3: x must never decrease */
            detail: string;
            /** @default [] */
            errors: components["schemas"]["FieldError"][];
        };
    };
    responses: never;
    parameters: never;
    requestBodies: never;
    headers: {
        /** @description this version, for If-None-Match */
        ETag: string;
        /** @description where what was made is */
        Location: string;
        /** @description where the plan is kept */
        "Content-Location": string;
        /** @description attachment and a file name */
        "Content-Disposition": string;
        /** @description the next page, rel="next"; absent on the last */
        Link: string;
        /** @description how many there are on all pages */
        "X-Total-Count": number;
        /** @description ask again after so many seconds */
        "Retry-After": number;
        /** @description Bearer */
        "WWW-Authenticate": string;
    };
    pathItems: never;
}
export type $defs = Record<string, never>;
export type operations = Record<string, never>;
