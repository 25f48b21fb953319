package fc.runtime

import java.io.File

/**
 * Holds the package of another protocol to its own vectors: the arguments are the project's root, the name of the package, the
 * folder of the vectors, and how many cases there are at least.
 */
internal fun main(arguments: Array<String>) {
    val (root, name, folder, atLeast) = arguments
    val tests = Tests(File(root))
    val type = Class.forName("$name.${name.replaceFirstChar { it.uppercase() }}")
    val protocol = type.getField("INSTANCE").get(null) as Protocol
    tests.suite(name, atLeast.toInt()) { Vectors(protocol, name).run(it, it.files(folder)) }
    tests.end()
}
