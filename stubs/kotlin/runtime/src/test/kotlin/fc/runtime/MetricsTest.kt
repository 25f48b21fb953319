package fc.runtime

import java.util.Collections
import java.util.concurrent.TimeUnit.MILLISECONDS
import java.util.function.Consumer
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.async
import kotlinx.coroutines.cancelAndJoin
import kotlinx.coroutines.coroutineScope

/** A hook that keeps what it gets. */
private class Recorder : Consumer<EndedCall> {
    val calls: MutableList<EndedCall> = Collections.synchronizedList(ArrayList())

    override fun accept(call: EndedCall) {
        calls.add(call)
    }

    val words: List<String> get() = calls.map { "${it.operation} ${it.result}" }
}

/** Tests of the hook for metrics. */
internal fun metricsTests(tests: Tests) {
    tests.net("both sides tell the end of each call") {
        val (ofApp, ofRobot) = Recorder() to Recorder()
        val gate = CompletableDeferred<Unit>()
        val robot = TestRobot(ServerConfig().onCall(ofRobot), gate)
        val app = Connection.connect(Toy, robot.config().onCall(ofApp))
        app.call(Toy.ECHO, Echo.of("hello"))
        for (text in listOf("refuse", "fail", "x".repeat(1_000_001))) runCatching { app.call(Toy.ECHO, Echo.of(text)) }
        app.callRaw(9, "{}")
        app.callRaw(100, "{\"text\":7}")
        coroutineScope {
            val dropped = async { app.call(Toy.GO, Go.of(1)) }
            robot.begun.await()
            dropped.cancelAndJoin()
        }
        runCatching { app.call(Toy.GO, Go.of(1), CallOptions().timeout(1, MILLISECONDS)) }
        gate.complete(Unit)
        app.close()
        app.closed()
        runCatching { app.call(Toy.ECHO, Echo.of("late")) }
        runCatching { app.callRaw(-1, "{}") }
        val told = listOf(
            "echo success", "echo refused", "echo refused", "echo invalid_request", "unknown success", "echo success",
            "go dropped", "go timeout", "echo closed",
        )
        expect(told, ofApp.words)
        expect(true, ofApp.calls.all { it.nanoseconds >= 0 }) { "${ofApp.calls}" }
        robot.server.shutdown(10_000, MILLISECONDS)
        val answered = listOf("echo success", "echo refused", "echo protocol", "unknown protocol", "echo invalid")
        expect(answered, ofRobot.words.take(answered.size))
        expect(true, ofRobot.words.drop(answered.size).all { it == "go success" }) { "${ofRobot.calls}" }
    }
    tests.net("a timeout of a handler is told") {
        val told = CompletableDeferred<EndedCall>()
        val robot = TestRobot(ServerConfig().handlerTimeout(5, MILLISECONDS).onCall { told.complete(it) }, CompletableDeferred())
        val app = robot.app()
        runCatching { app.call(Toy.GO, Go.of(1)) }
        val call = told.await()
        expect("go timeout", "${call.operation} ${call.result}")
        app.close()
        robot.server.close()
    }
    tests.net("a hook that fails is logged and harms nothing") {
        val lines = Collections.synchronizedList(ArrayList<String>())
        val log = Log { level, line -> if (level == LogLevel.ERROR) lines.add(line) }
        val fails = Consumer<EndedCall> { throw IllegalStateException("secret") }
        val robot = TestRobot(ServerConfig().onCall(fails).log(log))
        val app = Connection.connect(Toy, robot.config().onCall(fails).log(log))
        expect("hello", app.call(Toy.ECHO, Echo.of("hello")).text)
        app.close()
        app.closed()
        robot.server.shutdown(10_000, MILLISECONDS)
        expect(2, lines.count { it.startsWith("`onCall` failed: java.lang.IllegalStateException") }) { "$lines" }
        expect(false, "secret" in "$lines") { "$lines" }
    }
}
