package fc.runtime

import java.util.concurrent.CompletableFuture

/** The effect of a command on the robot. */
public enum class Effect {
    /** Only queries. */
    READ,

    /** Changes the data or configuration of the robot. */
    CONFIG,

    /** Moves the robot. */
    MOTION,

    /** Unknown. Treated like [MOTION] and never repeated automatically. */
    UNKNOWN,
}

/** A command: a request with a code and its response. The generated code has one value per command. */
public class Command<Q : Message, A : Message>(
    /** Name in the spec. */
    public val name: String,
    /** Command code. */
    public val code: Int,
    /** The effect on the robot. */
    public val effect: Effect,
    /** The type of the request. */
    public val request: MessageType<Q>,
    /** The type of the response. */
    public val response: MessageType<A>,
) {
    internal var declared: List<DeclaredError> = emptyList()

    /** Chinese title. */
    public var titleZh: String = name
        private set

    /** English title. */
    public var titleEn: String = name
        private set

    /** Sets the titles. */
    public fun titled(zh: String, en: String): Command<Q, A> = apply {
        titleZh = zh
        titleEn = en
    }

    /** Sets the declared results other than success. */
    public fun declares(vararg errors: DeclaredError): Command<Q, A> = apply { declared = errors.toList() }

    /** The conditions under which the robot accepts it; `null` if the spec specifies none. */
    public var preconditions: Preconditions? = null
        private set

    private fun conditions(change: (Preconditions) -> Preconditions): Command<Q, A> = apply {
        preconditions = change(preconditions ?: Preconditions(false, emptyList(), emptyList()))
    }

    /** Limits the command to these states, which may belong to several enums. */
    public fun accepted(vararg states: Any): Command<Q, A> =
        conditions { Preconditions(it.isAnyState, states.toList(), it.after) }

    /** Allows the command in any state. */
    public fun acceptedAlways(): Command<Q, A> = conditions { Preconditions(true, it.states, it.after) }

    /** Sets the names of the commands that come first. */
    public fun after(vararg commands: String): Command<Q, A> =
        conditions { Preconditions(it.isAnyState, it.states, commands.toList()) }

    /**
     * Returns `true` if the command is accepted in this state, as far as it depends on states of this enum. A state
     * that the spec does not define is not accepted then.
     */
    public fun isAcceptedIn(state: Any): Boolean {
        val states = preconditions?.states.orEmpty()
        return states.none { it.javaClass == state.javaClass } || state in states
    }

    override fun toString(): String = name
}

/** A named result other than success that a command declares. */
public open class DeclaredError(
    /** Name in the spec. */
    public val name: String,
    /** Result code. */
    public val code: Long,
    /** The text of the result. */
    public val text: String,
) {
    /** Returns the refusal for a handler to throw. */
    public fun refusal(): Refusal = Refusal(code, text)

    override fun toString(): String = name
}

/** A report: a message that is pushed and acknowledged. The generated code has one value per report. */
public class Report<R : Message>(
    /** Name in the spec. */
    public val name: String,
    /** Command code. */
    public val code: Int,
    /** The type of the message. */
    public val message: MessageType<R>,
    /** The type of the acknowledgement. */
    public val acknowledgement: MessageType<*>,
) {
    /** Chinese title. */
    public var titleZh: String = name
        private set

    /** English title. */
    public var titleEn: String = name
        private set

    /** Sets the titles. */
    public fun titled(zh: String, en: String): Report<R> = apply {
        titleZh = zh
        titleEn = en
    }

    /** The time at which it is sent; `null` if the spec does not specify it. */
    public var cadence: Cadence? = null
        private set

    internal var ack: AckPolicy? = null
    internal var stateOf: ((R) -> State?)? = null
    internal var failureOf: ((R) -> Boolean)? = null

    /** Sets an acknowledgement policy other than the default of the protocol. */
    public fun ack(ack: AckPolicy): Report<R> = apply { this.ack = ack }

    /** Sets the time at which it is sent. */
    public fun cadence(cadence: Cadence): Report<R> = apply { this.cadence = cadence }

    /** Sets the function that returns the state of the process, or `null` if a report has none. */
    public fun state(state: (R) -> State?): Report<R> = apply { stateOf = state }

    /** Sets the function that detects a failure, if the state does not. */
    public fun failure(failure: (R) -> Boolean): Report<R> = apply { failureOf = failure }

    internal fun stateIn(report: R): State? = stateOf?.invoke(report)

    internal fun isFailure(report: R): Boolean = failureOf?.invoke(report) ?: (stateIn(report)?.isError == true)

    override fun toString(): String = name
}

/** The result code and text of a refusal, from a handler or a robot. */
public class Refusal(
    /** Result code; not the one of success. */
    public val code: Long,
    /** Text for people. Never rely on it. */
    public val text: String,
) : Exception(null, null, false, false) {
    /** A future that has failed with this refusal, for a handler in Java. */
    public fun <T> toFuture(): CompletableFuture<T> = CompletableFuture<T>().also { it.completeExceptionally(this) }

    override val message: String get() = "refused with result $code: $text"

    override fun equals(other: Any?): Boolean = other is Refusal && other.code == code && other.text == text

    override fun hashCode(): Int = code.hashCode()
}
