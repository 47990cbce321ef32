/**
 * The lessons: one page about each demo, in `lessons/<language>/<name of the demo>.md`.
 *
 * A lesson file begins with its title, `# A publisher that counts` (a few words, no full stop), alone
 * on its line. The next line may say which demos it wants beside its own, by their names and in the
 * order in which they are started: `needs: listener` or `needs: jerry_robot jerry_client`; it is the
 * same in every language. An empty line, then the text in the markup of `lib/help-text.js`: blocks
 * between empty lines; `## Heading`, lists of `- entries` (an entry may go on in the next line), all
 * else paragraphs; in them `**name of a control**`, code in backticks, `{key Mod+K}`, `{icon eye}`.
 * No pictures, no HTML, no numbered lists.
 *
 * Links open panels, by the id that stands in `app/panels.js`, and may say what is shown there:
 *   `[words](topics)`  `[words](graph)`  any panel
 *   `[words](topics /chatter)`  that topic, opened
 *   `[words](parameters /turtlesim)`  that node's parameters
 *   `[words](services /spawn turtlesim/srv/Spawn)`  the form of that service; its type is needed
 *   `[words](actions /fibonacci example_interfaces/action/Fibonacci)`, `[words](publish /cmd_vel
 *   geometry_msgs/msg/Twist)`  likewise
 *   `[words](lessons listener)`  another lesson
 *
 * Names of topics, services, actions and nodes stand in backticks with their slash, as `/chatter`:
 * a test looks whether the demo's code, or that of one which it needs, has them.
 */

/**
 * @typedef {{title: string, needs: readonly string[], blocks: readonly import("../lib/help-text.js").Block[]}} Lesson
 */
