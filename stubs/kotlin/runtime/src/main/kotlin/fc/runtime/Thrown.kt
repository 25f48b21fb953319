package fc.runtime

/**
 * Describes errors of user code in the log by class and place. The message is left out, because it may quote a body.
 */
internal class Thrown(protocol: Protocol?) {
    /** The package of the generated code, which calls user code and is called by it. */
    private val generated = protocol?.javaClass?.name?.let(::packageOf)

    /**
     * Returns the class of an error, and its innermost line of user code. If no line is known, the class of [called]
     * replaces it: the object whose method failed.
     */
    fun describe(error: Throwable, called: Any? = null): String = try {
        val frames = generateSequence(error) { it.cause }.take(CAUSES).map { it.stackTrace.takeWhile(::isInside) }
        val own = frames.firstNotNullOfOrNull(::own)
        val place = when {
            own != null -> " at ${shown(own)}"
            called != null -> " in ${called.javaClass.name}"
            // A bug of the runtime itself.
            else -> error.stackTrace.firstOrNull()?.let { " at ${shown(it)}" } ?: ""
        }
        kind(error) + place
    } catch (_: Throwable) {
        // The class of the error may override its stack trace and cause, and they may fail.
        error.javaClass.name
    }

    /** Returns `true` inside the call of user code. Outer frames may be the test or program that runs the loop. */
    private fun isInside(frame: StackTraceElement): Boolean =
        CALLERS.none { frame.className == it || frame.className.startsWith("$it$") }

    private fun own(frames: List<StackTraceElement>): StackTraceElement? {
        val users = frames.filter { frame -> packageOf(frame.className) != RUNTIME && PLATFORM.none(frame.className::startsWith) }
        return users.firstOrNull { packageOf(it.className) != generated } ?: users.firstOrNull()
    }

    private fun kind(error: Throwable): String = when (error) {
        is BodyError -> if (error.path.isEmpty()) "BodyError (${error.name})" else "BodyError (${error.name} at `${error.path}`)"
        is FrameError -> "FrameError (${error.name})"
        else -> error.javaClass.name
    }

    private fun shown(frame: StackTraceElement): String {
        val method = "${frame.className}.${frame.methodName}"
        val file = frame.fileName ?: return method
        return if (frame.lineNumber < 0) "$file in $method" else "$file:${frame.lineNumber} in $method"
    }

    private companion object {
        /** Most causes to search for a line. A chain of causes may have no end. */
        const val CAUSES = 8
        val CALLERS = listOf(Peer::class, ServerCore::class, Context::class).map { it.java.name }
        val RUNTIME = packageOf(Thrown::class.java.name)
        val PLATFORM = listOf(
            "java.", "javax.", "jdk.", "sun.", "com.sun.", "kotlin.", "kotlinx.", "android.", "androidx.", "com.android.",
            "dalvik.", "libcore.",
        )

        fun packageOf(className: String): String = className.substringBeforeLast('.', "")
    }
}
