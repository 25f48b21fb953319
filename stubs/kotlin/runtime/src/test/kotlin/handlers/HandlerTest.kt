/** Failing handlers in another package than the runtime: the log names lines of user code. */
package handlers

import fc.runtime.Command
import fc.runtime.Context
import fc.runtime.Done
import fc.runtime.Echo
import fc.runtime.EchoReply
import fc.runtime.Empty
import fc.runtime.FrameId
import fc.runtime.Handler
import fc.runtime.Json
import fc.runtime.LogLevel
import fc.runtime.Message
import fc.runtime.Moved
import fc.runtime.RawRequest
import fc.runtime.Refusal
import fc.runtime.ServerConfig
import fc.runtime.ServerCore
import fc.runtime.Service
import fc.runtime.TestLoop
import fc.runtime.TestWire
import fc.runtime.Tests
import fc.runtime.Toy
import fc.runtime.Tree
import fc.runtime.expect
import java.io.ByteArrayOutputStream
import java.io.File
import java.io.PrintStream
import java.util.concurrent.CancellationException
import java.util.concurrent.CompletableFuture
import java.util.concurrent.CompletionStage
import java.util.concurrent.TimeUnit.MILLISECONDS
import java.util.function.BiFunction
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.CoroutineDispatcher
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.awaitCancellation
import kotlinx.coroutines.yield

/** Errors on lines that the tests find by their marks. */
private object Faults {
    fun helper(): Int = listOf<Int>()[0] // helper

    fun raise(): Nothing = throw IllegalStateException("secret") // raise

    fun library(): Int = Integer.parseInt("secret") // library

    fun caused(): Nothing = throw java.io.UncheckedIOException("secret", java.io.IOException("secret")) // caused

    fun recurse(depth: Int): Int = recurse(depth + 1) + 1 // recurse

    fun todo(): Nothing = TODO("secret") // todo

    fun cancel(): Nothing = throw CancellationException("secret") // cancel

    fun parse(): Moved = Moved.fromJson("{secret")
}

/** An error without a stack trace, whose methods fail. */
private class Hostile : RuntimeException(null, null, false, false) {
    override val message: String get() = throw IllegalStateException("secret")
    override val cause: Throwable get() = throw IllegalStateException("secret")

    override fun toString(): String = throw IllegalStateException("secret")
}

/** A robot on a clock of the test. */
private class Robot(
    service: Service,
    config: ServerConfig = ServerConfig(),
    dispatcher: CoroutineDispatcher = Dispatchers.Unconfined,
    isLogged: Boolean = true,
) {
    val lines = ArrayList<String>()
    val errors = ArrayList<Pair<Throwable, Context>>()
    val loop = TestLoop()
    private val wire = TestWire(loop)
    val core: ServerCore
    val panicked get() = fc.runtime.ServerCounters(core.counting.read()).handlersPanicked
    val answered get() = fc.runtime.ServerCounters(core.counting.read()).callsSucceeded

    init {
        val logged = config.log { level, line -> if (level == LogLevel.ERROR) lines.add(line) }
        val told = logged.onHandlerError { error, context -> errors.add(error to context) }
        core = ServerCore(Toy, if (isLogged) told else config, loop, service, CoroutineScope(SupervisorJob() + dispatcher))
        core.serve(wire.link, null)
        loop.settle()
    }

    fun call(code: Int, id: Long = 7, body: String = "{\"text\":\"\",\"metres\":1}"): List<Tree> {
        wire.send(FrameId(false, Toy.commandKind, code, id), body)
        loop.settle()
        return answers()
    }

    fun answers(): List<Tree> = wire.frames().map { Tree.of(String(it.body)) }

    val isOpen get() = !wire.link.hasGone
}

private fun echo(handle: suspend () -> EchoReply) = Service().on(Toy.ECHO) { _, _ -> handle() }

/** A handler in the style of Java. */
@Suppress("UNCHECKED_CAST")
private fun java(result: Any?): Service {
    val handler = BiFunction<Context, Echo, Any?> { _, _ -> result }
    return Service().onAsync(Toy.ECHO, handler as BiFunction<Context, Echo, CompletionStage<EchoReply>>)
}

private fun done(value: Any?): CompletableFuture<Any?> = CompletableFuture.completedFuture(value)

internal fun handlerTests(tests: Tests) {
    val source = File(tests.root, "stubs/kotlin/runtime/src/test/kotlin/handlers/HandlerTest.kt").readLines()
    fun line(mark: String) = "at HandlerTest.kt:${source.indexOfFirst { it.endsWith("// $mark") } + 1} in handlers."

    /** Failures, and how the log describes them. */
    val failures = listOf<Triple<String, String, Service>>(
        Triple("itself", "java.lang.IllegalStateException ${line("itself")}", echo { throw IllegalStateException("secret") }), // itself
        Triple("in a helper", "Exception ${line("helper")}", echo { EchoReply.of("${Faults.helper()}") }),
        Triple("in the library", "java.lang.NumberFormatException ${line("library")}", echo { EchoReply.of("${Faults.library()}") }),
        Triple("with a cause", "java.io.UncheckedIOException ${line("caused")}", echo { Faults.caused() }),
        Triple("in the runtime", "BodyError (bad_json) in handlers.", echo { EchoReply.of("${Faults.parse()}") }),
        Triple("after a pause", "java.lang.IllegalStateException ${line("raise")}", echo {
            yield()
            Faults.raise()
        }),
        Triple("by an error", "kotlin.NotImplementedError ${line("todo")}", echo { Faults.todo() }),
        Triple("without end", "java.lang.StackOverflowError ${line("recurse")}", echo { EchoReply.of("${Faults.recurse(0)}") }),
        Triple("by its own cancellation", "CancellationException ${line("cancel")}", echo { Faults.cancel() }),
        Triple("with a hostile error", "handlers.Hostile", echo { throw Hostile() }),
        Triple("by refusing with success", "fc.runtime.Refusal in handlers.", echo { throw Refusal(0, "secret") }),
        Triple(
            "in a future", "java.lang.IllegalStateException ${line("raise")}",
            java(CompletableFuture<Any?>().also { future ->
                future.completeExceptionally(runCatching { Faults.raise() }.exceptionOrNull())
            }),
        ),
        Triple("without a future", "java.lang.NullPointerException in handlers.", java(null)),
    )
    for ((name, described, service) in failures) {
        tests.case("a handler that fails $name is answered, logged and told") {
            val robot = Robot(service)
            val answer = robot.call(100).single()
            expect(listOf("1", "protocol: the handler failed"), listOf(answer["result"].text, answer["said"].text))
            val said = robot.lines.single()
            expect(true, said.startsWith("the handler of echo failed: ") && described in said) { "$described: $said:" }
            expect(false, "secret" in said) { said }
            val context = robot.errors.single().second
            expect(listOf<Any>(100, 7L, 1L, true), listOf(context.code, context.id, robot.panicked, robot.isOpen))
        }
    }

    @Suppress("UNCHECKED_CAST")
    val ofAnotherType = Service().on(Toy.ECHO as Command<Echo, Done>) { _, _ -> Done.of() }
    @Suppress("UNCHECKED_CAST")
    val raw = { answer: Any? -> BiFunction { _: Context, _: RawRequest -> done(answer) as CompletionStage<Json> } }
    val wrong = listOf<Triple<String, Int, Service>>(
        Triple("wrong_type", 100, java(done(null))),
        Triple("wrong_type", 100, java(done("{\"text\":\"\"}"))),
        Triple("wrong_type", 100, java(done(Json.of("{}")))),
        Triple("wrong_type", 100, java(done(EchoReply))),
        Triple("wrong_type", 100, java(done(Empty.INSTANCE))),
        Triple("wrong_type", 100, ofAnotherType),
        Triple("lone_surrogate at `text`", 100, echo { EchoReply.of("\uD800") }),
        Triple("frame_too_long", 100, echo { EchoReply.of("x".repeat(17_000_000)) }),
        Triple("out_of_range", 100, echo { throw Refusal(1L shl 40, "no") }),
        Triple("wrong_type", 500, Service().onRangeAsync(500, 500, raw(null))),
        Triple("wrong_type", 500, Service().onRangeAsync(500, 500, raw(EchoReply.of("")))),
        Triple("not_an_object", 500, Service().onRangeAsync(500, 500, raw(Json.of("[1]")))),
        Triple("not_an_object", 500, Service().onUnknown { _, _ -> Json.NULL }),
        Triple("wrong_type at `result`", 500, Service().onUnknown { _, _ -> Json.of("{\"result\":\"secret\"}") }),
    )
    wrong.forEachIndexed { index, (name, code, service) ->
        tests.case("a response that breaks the spec is not sent: $index, $name") {
            val robot = Robot(service)
            val answer = robot.call(code).single()
            expect(listOf("1", "protocol"), listOf(answer["result"].text, answer["said"].text))
            val said = robot.lines.single()
            val command = if (code == 100) "echo" else "0x01F4"
            expect(true, said.startsWith("the response to $command breaks the spec: ") && "Error ($name) in " in said) { said }
            expect(false, "secret" in said) { said }
            expect(listOf<Any>(1, 0L, 0L), listOf(robot.errors.size, robot.panicked, robot.answered))
        }
    }
    lateTests(tests)
    hookTests(tests)
}

private fun lateTests(tests: Tests) {
    tests.case("handlers that never return are answered for, and harm nothing") {
        var cancelled = 0
        val robot = Robot(
            Service()
                .on(Toy.ECHO) { _, _ ->
                    try {
                        awaitCancellation()
                    } finally {
                        cancelled++
                    }
                }
                .on(Toy.GO) { _, _ -> awaitCancellation() },
        )
        for (code in listOf(100, 200)) expect(0, robot.call(code).size)
        robot.loop.advance(2000)
        expect(listOf("2", "2"), robot.answers().map { it["result"].text })
        expect(listOf<Any>(1, 0, 0, 0L), listOf(cancelled, robot.lines.size, robot.errors.size, robot.panicked))
    }
    tests.case("handlers that fail after their timeout are logged and told") {
        val gate = CompletableDeferred<Unit>()
        val robot = Robot(
            Service()
                .on(Toy.ECHO) { _, _ ->
                    try {
                        awaitCancellation()
                    } finally {
                        Faults.raise()
                    }
                }
                .on(Toy.GO) { _, _ ->
                    gate.await()
                    Faults.raise()
                },
        )
        for (code in listOf(100, 200)) robot.call(code)
        robot.loop.advance(2000)
        gate.complete(Unit)
        robot.loop.settle()
        expect(2, robot.answers().size)
        expect(listOf(100, 200), robot.errors.map { it.second.code })
        expect(listOf(2, 2), listOf(robot.lines.size, robot.panicked.toInt()))
    }
    tests.case("a refusal after the timeout is no failure") {
        val gate = CompletableDeferred<Unit>()
        val robot = Robot(Service().on(Toy.GO) { _, _ ->
            gate.await()
            throw Refusal(3, "late")
        })
        robot.call(200)
        robot.loop.advance(2000)
        gate.complete(Unit)
        robot.loop.settle()
        expect(listOf(1, 0, 0), listOf(robot.answers().size, robot.errors.size, robot.lines.size))
    }
    tests.case("a dispatcher that takes no more work costs the call alone") {
        val executor = java.util.concurrent.Executors.newSingleThreadExecutor().also { it.shutdown() }
        val dispatcher = object : CoroutineDispatcher() {
            override fun dispatch(context: kotlin.coroutines.CoroutineContext, block: Runnable) = executor.execute(block)
        }
        val robot = Robot(echo { EchoReply.of("") }, dispatcher = dispatcher)
        expect(listOf("1"), robot.call(100).map { it["result"].text })
        expect(listOf("1"), robot.call(999).map { it["result"].text })
    }
}

private fun hookTests(tests: Tests) {
    tests.case("many failures are few lines, and all reach the hook") {
        val failing = Handler<Message, EchoReply> { _, _ -> Faults.raise() }
        @Suppress("UNCHECKED_CAST")
        val robot = Robot(
            Service().on(Toy.ECHO, failing as Handler<Echo, EchoReply>).on(Toy.GO) { _, _ -> Faults.raise() }
                .onUnknown { _, _ -> Faults.raise() },
        )
        for (id in 0 until 50L) robot.call(100, id)
        robot.call(200)
        // Apps choose the codes, so all unknown codes are one cause.
        for (code in 1000 until 1020) robot.call(code)
        expect(listOf(11, 71), listOf(robot.lines.size, robot.errors.size))
    }
    tests.case("errors of the hook, of the log and of actions harm nothing") {
        val lines = ArrayList<String>()
        val config = ServerConfig().handlerTimeout(5, MILLISECONDS).onHandlerError { _, _ -> Faults.helper() }
        val service = Service().on(Toy.ECHO) { _, _ -> Faults.raise() }.on(Toy.GO) { context, _ ->
            context.onAbandoned { Faults.library() }
            awaitCancellation()
        }
        val robot = Robot(service, config.log { _, line -> lines.add(line) }, isLogged = false)
        expect(listOf("1"), robot.call(100).map { it["result"].text })
        robot.call(200)
        robot.loop.advance(5)
        expect(listOf("2"), robot.answers().map { it["result"].text })
        for ((what, mark) in listOf("`onHandlerError` failed" to "Faults.helper", "an action of `onAbandoned` failed" to "Faults.library")) {
            expect(true, lines.any { it.startsWith(what) && mark in it }) { "$lines:" }
        }
        expect(false, "secret" in "$lines")
        val silent = Robot(service, ServerConfig().log { _, _ -> Faults.raise() }, isLogged = false)
        expect(listOf("1"), silent.call(100).map { it["result"].text })
        expect(true, silent.isOpen)
    }
    tests.case("without a log, errors are printed") {
        val printed = ByteArrayOutputStream()
        val before = System.err
        System.setErr(PrintStream(printed, true))
        try {
            Robot(echo { Faults.raise() }, isLogged = false).call(100)
        } finally {
            System.setErr(before)
        }
        val lines = printed.toString().trim().lines()
        expect(listOf(1, true), listOf(lines.size, "the handler of echo failed: java.lang.IllegalStateException at " in lines[0]))
    }
}
